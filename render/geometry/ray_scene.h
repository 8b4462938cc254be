// Ray casting against the pieces: what rests is one mesh, and each piece that moves is placed anew when the scene has
// moved on. Hits have the same bits on every machine; of equally near ones that of the smallest triangle counts. Internal
// to render/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/geometry/ray_tree.h"

namespace rubble {

class RayScene {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Triangle {
    std::uint32_t placed;  // which placed mesh
    std::uint32_t source;  // its triangle in the prepared mesh
  };
  struct Hit {
    std::uint32_t triangle = kNone;  // for triangle()
    float distance = 0;              // unit: lengths of the ray's direction
    bool back = false;               // from inside
  };

  enum class Detail { coarsest, finest };  // which level of each piece
  enum class Part { all, solid, glass };   // which of its triangles: solid ones are those that are no glass

  struct Ray {
    Vec3f from;          // in the world; unit: m
    float nearest = 0;   // unit: lengths of `direction`, as all distances here
    Vec3f direction;     // in the world; of any length
    float farthest = 0;  // unit: lengths of `direction`
  };
  struct PreciseHit {
    std::uint32_t triangle = kNone;  // for triangle()
    float distance = 0;              // unit: lengths of the ray's direction
    float u = 0, v = 0;              // weights of the triangle's second and third corner
    bool back = false;               // from inside
  };
  // Packets pay where neighbouring rays go the same way; elsewhere each ray goes alone. The bits are the same.
  enum class Order { coherent, scattered };

  // The scene must outlive it.
  explicit RayScene(const PreparedScene& scene, Detail detail = Detail::coarsest, Part part = Part::all);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Puts what moves where it is in the scene now. Not while another thread casts.
  void follow();

  // May be called from several threads.
  Hit cast(const Vec3f& from, const Vec3f& direction, float nearest, float farthest) const;
  bool blocked(const Vec3f& from, const Vec3f& direction, float nearest, float farthest) const;
  // The same for `count` rays at once: hits[i] is that of rays[i], hidden[i] is 1 where it is blocked.
  void cast_many(const Ray* rays, std::size_t count, Order order, PreciseHit* hits) const;
  void blocked_many(const Ray* rays, std::size_t count, Order order, std::uint8_t* hidden) const;
  // Of its number; below triangle_count(). Those of a placed mesh follow each other.
  Triangle triangle(std::uint32_t number) const;
  std::uint32_t triangle_count() const { return triangle_count_; }

 private:
  // Of a mesh, what is cast against.
  struct MeshBlocks {
    std::vector<std::uint32_t> sources;  // triangles of the prepared mesh
    BlockOrder order;                    // of `sources`
    std::uint32_t in_tree = RayTree::kNone;  // of what moves
  };
  struct PlacedTriangles {
    std::uint32_t first, placed;  // number of the first; which placed mesh
    const MeshBlocks* blocks;
  };
  void add_triangles(std::uint32_t placed, const MeshBlocks& blocks);
  const PreparedLevel& level_of(const PreparedMesh& mesh) const;
  bool has(const PreparedTriangle& triangle) const;  // it is of the part
  MeshBlocks& blocks_of(std::uint32_t mesh);
  void add_resting();
  void add_moving();
  void place(std::size_t mover);

  const PreparedScene& scene_;
  Detail detail_;
  Part part_;
  RayTree tree_;  // what rests is its first part, movers follow
  std::map<std::uint32_t, MeshBlocks> meshes_;
  // There are millions of triangles: which one a number means is looked up, from where its run of numbers is.
  static constexpr std::uint32_t kRun = 256;
  std::vector<PlacedTriangles> placed_;
  std::vector<std::uint32_t> runs_;  // of each run, which of placed_ has its first number
  std::uint32_t triangle_count_ = 0;
  std::vector<std::uint32_t> movers_;  // placed meshes
  std::uint64_t moment_ = 0;  // of the scene when it was followed last
};

}  // namespace rubble
