// The parts of a bake, see bake.h. Internal to render/lighting.
//
// First some rays of each point are traced and kept, by the bake point at what they meet, drawn by its weight
// there; over them light goes from surface to surface some times. Each point has neighbours from which it may
// take light, as far as that may be the same there. From what the first rays of the points about it say follows
// how many more a point needs for the mean over its neighbours to be quiet. Last, the means are taken.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "render/geometry/glass_sheets.h"
#include "render/geometry/point_cells.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/bake.h"

namespace rubble {

class Baker {
 public:
  struct Spoke {  // of a fan of rays
    float stratum;   // of heights, from 0
    float cos, sin;  // of its azimuth
  };

  Baker(const PreparedScene& scene, const RayScene& solid, const LightSet& light, const AlbedoAt& albedo,
        const BakeOptions& options);

  void run(const std::function<void(double)>& progress);
  std::vector<BakedLight> node_light() const;
  // One a triangle of rays(), over pi; unit: kcd/m2.
  std::vector<Vec3f> triangle_radiance() const;
  BakeLinks links() const;
  const RayScene& rays() const { return rays_; }

 private:
  // Instead of a point; kNone: a ray that does not count.
  static constexpr std::uint32_t kSky = 0xffffffffu, kInside = 0xfffffffeu, kNone = 0xfffffffdu;
  static constexpr std::size_t kFirstRays = BakeLinks::kPerPoint;  // of a point, that are kept
  static constexpr std::size_t kRound = 32;      // rays between two looks at the noise
  static constexpr std::size_t kMostOrigins = 8;

  struct Point {
    Vec3f position, normal;  // in the world
    Vec3f direct;            // of the lights; unit: klx
    Vec3f sky;               // mean radiance that its first rays meet, of the sky alone; unit: kcd/m2
    Vec3f indirect;          // of sky and surfaces; unit: klx
    Vec3f vector;            // dot(n, vector) is the strength of `indirect` on a normal n near its own
    float clearance = 0;     // harmonic mean of the distances of what it sees; unit: m
    float light_distance = 0;  // harmonic mean of the distances that light comes from; unit: m
    float room = 0;          // mean distance of what it sees, where more than kWide counts as that; unit: m
    float noise_left = 1;    // variance of the mean over its neighbours, as a share of its own
    std::uint32_t piece = 0, source = 0;  // placed mesh, and its bake point
    std::uint8_t open = 0;   // origins outside all pieces, one bit each
  };
  struct Neighbour {
    std::uint32_t point;
    float weight;  // beside 1 for the point itself
  };
  // Turned by another angle and moved within their strata for each set of rays: light through a slit far away comes
  // from a few heights alone, which fixed ones would miss at many points.
  struct Fan {
    const std::vector<Spoke>& spokes;
    Vec3f x, y, z;
    float height;  // within each stratum, in [0, 1)
    Vec3f direction(std::size_t spoke) const;
  };
  struct Sum {  // of what rays say
    Vec3f light, direction;  // of radiance; and of directions by its strength
    float squares = 0;       // of strengths
    int rays = 0;

    void add(const Vec3f& radiance, const Vec3f& w, float cosine);  // cosine: of the ray with the normal
    void finish(Point& p) const;
  };
  struct Region {
    std::vector<std::uint32_t> points;
    Sum sum;                    // of their first rays
    float bright_nearness = 0;  // the sum of their radiance over the distance that it comes from
  };
  using Regions = std::map<std::array<int, 4>, Region>;  // of cells of space, and the side of the surface

  std::size_t end_point(std::size_t piece) const {
    return piece + 1 < first_point_.size() ? first_point_[piece + 1] : points_.size();
  }
  void list_points();
  void find_nearest_points();
  void find_albedos(const AlbedoAt& albedo);
  template <typename Work>
  void over_points(double from, double to, const std::function<void(double)>& progress, const Work& work);

  // baker_gather.cpp
  Fan fan(std::size_t point, std::uint32_t round) const;   // round 0: that of the first rays
  BakeOrigin origin(const Point& p, std::size_t i) const;  // in the world, off the surface
  bool below_soil(const Point& p) const;
  std::size_t origin_count(const Point& p) const;
  // Share of light that glass leaves of what comes along a ray, grey; `farthest` where it meets something.
  float cleared(const RayScene::Ray& ray, float farthest) const;
  float first_cleared(std::size_t ray) const;  // of a first ray
  void trace(std::size_t point);         // its first rays
  std::vector<BakeOrigin> direct_places(std::size_t point) const;
  void find_direct(std::size_t point);
  Vec3f find_far(Point& p) const;        // adds it to the direct light; the vector of it, as Point::vector
  void show_far_light();                 // in what is kept at nodes
  void gather_first(std::size_t point);  // by them
  void gather(std::size_t point);        // by them and as many more as were planned
  Sum first_sum(std::size_t point) const;
  void plan(std::size_t piece);
  Regions look_about(std::size_t piece);
  float bright_nearness(std::size_t point) const;
  int rounds_for(const Point& p, const Sum& about) const;
  void add_round(std::size_t point, std::uint32_t round, Sum& sum) const;
  std::uint32_t drawn_point(const RayScene::PreciseHit& hit, float draw) const;

  // bake_smooth.cpp
  float reach_of(const Point& p) const;  // of neighbours; 0: none; unit: m
  std::vector<PointCells::Point> open_points(std::uint32_t first, std::uint32_t end) const;
  void join_neighbours(std::uint32_t point, const PointCells& grid, std::vector<RayScene::Ray>& lines);
  void find_neighbours(std::size_t piece);
  void smooth(std::size_t point, Point& out) const;
  void find_substitutes();
  void fill_closed();

  void update_radiance();

  const PreparedScene& scene_;
  const LightSet& light_;
  BakeOptions options_;
  const RayScene& rays_;  // of all but glass
  GlassSheets sheets_;    // of glass, which dims light and does nothing else to it
  std::vector<Spoke> first_spokes_, spokes_;        // spread evenly, cosine-weighted
  std::vector<Point> points_;                       // of all placed meshes
  std::vector<std::uint32_t> first_point_;          // of each placed mesh
  std::vector<std::uint32_t> first_hits_;           // of each point in turn: a point, kSky, kInside or kNone
  std::vector<std::uint8_t> first_cleared_;         // share that glass leaves of each, 255: all; empty: there is no glass
  std::vector<std::vector<std::uint32_t>> nearest_points_;  // of each mesh: to each node, in the mesh
  std::vector<Vec3f> far_light_, far_vectors_;      // of LightSet::far, of each point; empty: there are none
  std::vector<Sum> sums_;                           // of the rays of each point
  std::vector<int> rounds_;                         // that each point gathers by, besides its first rays
  std::vector<std::vector<Neighbour>> neighbours_;  // of each point
  std::vector<std::uint32_t> substitutes_;          // for a point that is inside a piece: whose light it takes
  std::vector<Vec3f> albedos_, radiance_;           // of each point, matt; unit of the latter: kcd/m2
};

}  // namespace rubble
