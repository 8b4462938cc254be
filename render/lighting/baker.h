// The parts of a bake, see bake.h. Internal to render/lighting.
//
// First a few rays of each point are traced and kept, by the node of light nearest to what they meet; over
// them light goes from surface to surface some times. Then each point gathers once more with many rays, the
// light between nodes, until its noise is small. Last, points take in what neighbours say as far as light
// may be the same there.
#pragma once

#include <functional>
#include <vector>

#include "render/geometry/ray_scene.h"
#include "render/lighting/bake.h"

namespace rubble {

class Baker {
 public:
  Baker(const PreparedScene& scene, const LightSet& light, const AlbedoAt& albedo, const BakeOptions& options);

  void run(const std::function<void(double)>& progress);
  std::vector<BakedLight> node_light() const;
  // One a triangle of rays(), over pi; unit: kcd/m2.
  std::vector<Vec3f> triangle_radiance() const;
  BakeLinks links() const;
  const RayScene& rays() const { return rays_; }

 private:
  static constexpr std::uint32_t kSky = 0xffffffffu, kInside = 0xfffffffeu, kNone = 0xffffffffu;

  struct Point {
    Vec3f position, normal;  // in the world
    Vec3f direct;            // of the lights; unit: klx
    Vec3f indirect;          // of sky and surfaces; unit: klx
    Vec3f vector;            // dot(n, vector) is the strength of `indirect` on a normal n near its own
    float clearance = 0;     // harmonic mean of the distances of what it sees; unit: m
    std::uint32_t piece = 0, source = 0;  // placed mesh, and its bake point
    std::uint8_t open = 0;   // origins outside all pieces, one bit each
  };
  struct Basis {
    Vec3f x, y, z;
    Vec3f operator*(const Vec3f& d) const { return x * d.x + y * d.y + z * d.z; }
  };
  struct Sum;

  void list_points();
  void find_albedos(const AlbedoAt& albedo);
  template <typename Work>
  void over_points(double from, double to, const std::function<void(double)>& progress, const Work& work);

  Basis basis_of(std::size_t point, std::uint32_t round) const;
  BakeOrigin origin(const Point& p, std::size_t i) const;  // in the world, off the surface
  std::size_t origin_count(const Point& p) const;
  void trace(std::size_t point);          // its first rays
  void find_direct(Point& p) const;
  void gather_first(std::size_t point);   // by them
  void gather(std::size_t point);         // by many
  void add_round(std::size_t point, std::uint32_t round, Sum& sum) const;
  Vec3f light_met(const RayScene::PreciseHit& hit) const;
  std::uint32_t nearest_node(const RayScene::PreciseHit& hit) const;

  Vec3f mixed(std::size_t piece, const LightNode& node, Vec3f Point::*what) const;
  void update_radiance();
  void find_substitutes();
  void fill_closed();
  void smooth(std::size_t piece, std::vector<Point>& out) const;

  const PreparedScene& scene_;
  const LightSet& light_;
  BakeOptions options_;
  RayScene rays_;
  std::vector<Vec3f> first_directions_, directions_;  // about +Z
  std::vector<Point> points_;                  // of all placed meshes
  std::vector<std::uint32_t> first_point_;     // of each placed mesh
  std::vector<std::uint32_t> first_hits_;      // of each point in turn: node, kSky or kInside
  std::vector<std::uint32_t> substitutes_;     // for a point that is inside a piece: whose light it takes
  std::vector<Vec3f> albedos_;                 // one a node of each placed mesh
  std::vector<Vec3f> radiance_;                // of the same nodes, matt; unit: kcd/m2
};

}  // namespace rubble
