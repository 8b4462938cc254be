// What rays meet: triangles that rest, and meshes that are placed. Embree's trees say which blocks of triangles a ray may
// meet; what it does meet is computed here (triangle_block.h). So neither the version of Embree nor its instruction set
// changes a bit. Internal to what casts rays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/geometry/triangle_block.h"

namespace rubble {

class RayTree {
 public:
  static constexpr std::uint32_t kNone = TriangleBlock::kNone;

  struct Line {
    Vec3f from;          // unit: m
    Vec3f direction;     // of any length
    float nearest = 0;   // unit: lengths of `direction`, as all distances; a hit is not nearer than this
    float farthest = 0;  // a hit is not farther than this
    float time = 0;      // from 0 to 1: between the two poses of what moves
  };
  struct Hit : BlockHit {         // normal: in the frame of the mesh
    std::uint32_t part = kNone;   // which part is met; kNone: nothing
  };
  // A mesh where it is. While the ray's time goes from 0 to 1 it moves along a straight line, with a constant turn.
  struct Part {
    std::uint32_t mesh = kNone;      // by add_mesh(); kNone: not there
    std::uint32_t first_id = 0;      // is added to the numbers of its triangles: no two parts have one in common
    double scale = 1;                // of the mesh; range: above 0
    Pose first, last;                // at times 0 and 1; unit: m
  };

  // reach: farthest from the origin that anything is, but for very far ground; unit: m. Throws RunError where Embree
  // gives no device.
  explicit RayTree(double reach);
  ~RayTree();
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;

  // smallest_scale: of the parts that will be of the mesh. Numbers of triangles: as corners() has them. A mesh without
  // triangles is none: kNone. Throws RunError where memory is short.
  std::uint32_t add_mesh(const BlockOrder& order, const TriangleCorners& corners, double smallest_scale = 1);
  std::uint32_t add_mesh(std::vector<TriangleBlock> blocks);  // whose frame is the world's
  void drop_mesh(std::uint32_t mesh);  // no part is of it any more

  // Changes take effect at commit(). Not while another thread casts.
  std::vector<Part>& parts() { return parts_; }
  const std::vector<Part>& parts() const { return parts_; }
  // Throws RunError where Embree reports an error.
  void commit();

  // May be called by several threads.
  Hit meet(const Line& line) const;
  bool hides(const Line& line) const;
  // The same for kPacket lines at most at once, with the same bits: quicker where they go the same way.
  static constexpr std::size_t kPacket = 8;
  void meet_packet(const Line* lines, std::size_t count, Hit* hits) const;
  void hide_packet(const Line* lines, std::size_t count, std::uint8_t* hidden) const;

 private:
  struct Embree;

  bool has_packets(const Line* lines, std::size_t count) const;

  double reach_;
  std::vector<Part> parts_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace rubble
