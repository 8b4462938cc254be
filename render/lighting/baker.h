// The parts of a bake, see bake.h. Internal to render/lighting.
//
// First some rays of each point are traced and kept, by the bake point at what they meet, drawn by its weight
// there; over them light goes from surface to surface some times. That is the solution, of all points at once.
// From it the light of each piece is found apart, when it is asked for: each point has neighbours on its piece from
// which it may take light, as far as that may be the same there; from what the first rays of the points about it
// say follows how many more a point needs for the mean over its neighbours to be quiet; last, the means are taken.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "render/geometry/glass_sheets.h"
#include "render/geometry/point_cells.h"
#include "render/geometry/scene_rays.h"
#include "render/lighting/bake.h"

namespace rubble {

class Baker {
 public:
  struct Spoke {  // of a fan of rays
    float stratum;   // of heights, from 0
    float cos, sin;  // of its azimuth
  };

  // All must outlive it.
  Baker(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const BakeOptions& options);

  void solve(const AlbedoAt& albedo, const std::function<void(double)>& progress);
  // The solution. restore(): false where it is not one of this scene; then it must be solved.
  void save(CacheWriter& to) const;
  bool restore(CacheReader& from);

  // Of the solution. nodes: of all placed meshes; those of `pieces`, each once, are found.
  void light_pieces(const std::vector<std::uint32_t>& pieces, LightTable& nodes);
  // Of the solution, over pi; unit: kcd/m2. May be called from several threads.
  Vec3f triangle_radiance(const RayScene::Triangle& triangle) const;
  BakeLinks links() const { return {first_spokes_.size(), first_hits_, substitutes_, places_, albedos_}; }
  const std::vector<Vec3f>& radiance() const { return radiance_; }  // of each point, matt; unit: kcd/m2

 private:
  static constexpr std::uint32_t kSky = BakeLinks::kSky, kInside = BakeLinks::kInside, kNone = BakeLinks::kNone;
  static constexpr std::size_t kFirstRays = 24;  // of a point, that are kept
  static constexpr std::size_t kRound = 32;      // rays between two looks at the noise
  static constexpr std::size_t kMostOrigins = 8;
  static constexpr float kContact = 0.7f;        // light left where pieces touch

  struct Point {
    Vec3f direct;            // of the lights; unit: klx
    Vec3f indirect;          // of sky and surfaces, by its first rays; unit: klx
    float clearance = 0;     // harmonic mean of the distances of what it sees; unit: m
    float room = 0;          // mean distance of what it sees, where more than kWide counts as that; unit: m
    std::uint32_t piece = 0, source = 0;  // placed mesh, and its bake point
    std::uint8_t open = 0;   // origins outside all pieces, one bit each
  };
  struct Solved {  // what of a point is kept
    Vec3f direct, indirect;
    float clearance, room;
    std::uint32_t open;
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
  };
  struct Arrived {
    Vec3f indirect;          // of sky and surfaces; unit: klx
    Vec3f vector;            // dot(n, vector) is the strength of `indirect` on a normal n near that of the point
  };
  // A point while the light of its piece is found.
  struct Found {
    Sum sum;                   // of its rays
    int rounds = 0;            // that it gathers by, besides its first rays
    float light_distance = 0;  // harmonic mean of the distances that light comes from; unit: m
    float noise_left = 1;      // variance of the mean over its neighbours, as a share of its own
    Arrived arrived;
    std::vector<Neighbour> neighbours;
  };
  struct Piece {
    std::uint32_t number, first, end;  // placed mesh, and its points
    std::vector<Found> found;          // one a point
    Found& of(std::uint32_t point) { return found[point - first]; }
    const Found& of(std::uint32_t point) const { return found[point - first]; }
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
  const BakePlace& place_of(const Point& p) const { return places_[std::size_t(&p - points_.data())]; }
  void list_points();
  void find_nearest_points();
  void find_albedos(const AlbedoAt& albedo);
  template <typename Work>
  void over_points(double from, double to, const std::function<void(double)>& progress, const Work& work);
  void update_radiance();
  void mark_closed();
  // What comes along a first ray that meets a surface.
  const Vec3f& radiance_at(std::uint32_t hit) const { return radiance_[hit & ~BakeLinks::kClosed]; }
  void fill_closed();
  void light_at_once(std::vector<Piece>& work, LightTable& nodes) const;
  void store_nodes(const Piece& piece, LightTable& nodes) const;

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
  Vec3f find_far(Point& p) const;        // adds it to the direct light; the vector of it, as Arrived::vector
  void gather_first(std::size_t point);  // by its first rays
  Sum first_sum(std::size_t point) const;
  void plan(Piece& piece) const;
  Regions look_about(Piece& piece) const;
  float bright_nearness(std::size_t point) const;
  int rounds_for(const Point& p, float noise_left, const Sum& about) const;
  void add_round(std::size_t point, std::uint32_t round, Sum& sum) const;
  void gather(std::size_t point, Found& found) const;  // by its first rays and as many more as were planned
  std::uint32_t drawn_point(const RayScene::PreciseHit& hit, float draw) const;

  // bake_smooth.cpp
  float reach_of(const Point& p, float light_distance) const;  // of neighbours; 0: none; unit: m
  std::vector<PointCells::Point> open_points(std::uint32_t first, std::uint32_t end) const;
  void join_neighbours(std::uint32_t point, const PointCells& grid, Piece& piece, std::vector<RayScene::Ray>& lines) const;
  void find_neighbours(Piece& piece) const;
  void smooth(Piece& piece) const;
  void find_substitutes();

  const PreparedScene& scene_;
  const LightSet& light_;
  BakeOptions options_;
  SceneRays& scene_rays_;
  const RayScene* rays_ = nullptr;  // of all but glass; null: not asked for yet
  GlassSheets sheets_;    // of glass, which dims light and does nothing else to it
  std::vector<Spoke> first_spokes_, spokes_;        // spread evenly, cosine-weighted
  std::vector<Point> points_;                       // of all placed meshes
  std::vector<BakePlace> places_;                   // of these points
  std::vector<Vec3f> sky_;                          // mean radiance that first rays meet, of the sky alone, while solving; unit: kcd/m2
  std::vector<std::uint32_t> first_point_;          // of each placed mesh
  std::vector<std::uint32_t> first_hits_;           // of each point in turn, as links: a point, kSky, kInside or kNone
  std::vector<std::uint8_t> first_cleared_;         // share that glass leaves of each, 255: all; empty: there is no glass
  std::vector<std::vector<std::uint32_t>> nearest_points_;  // of each mesh: to each node, in the mesh
  std::vector<Vec3f> far_light_, far_vectors_;      // of LightSet::far, of each point; empty: there are none
  std::vector<std::uint32_t> substitutes_;          // for a point that is inside a piece: whose light it takes
  std::vector<Vec3f> albedos_, radiance_;           // of each point, matt; unit of the latter: kcd/m2
};

}  // namespace rubble
