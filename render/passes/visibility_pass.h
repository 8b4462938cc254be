// Draws which triangle each pixel shows, and its depth, and nothing else. Pieces that cannot be
// seen are left out: those that showed last time are drawn first, and the depth they leave decides
// about the others, exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "render/culling.h"
#include "render/geometry.h"
#include "render/projection.h"

namespace rubble {

struct VisibilityOptions {
  bool occlusion_culling = true;
  // Use coarser levels where a level-0 triangle would be about this small on the image; 0: always
  // the finest. unit: pixel
  double coarse_below = 0;
};

struct DrawCommand {  // as glMultiDrawElementsIndirect wants it
  std::uint32_t count, instances, first_index, base_vertex, base_instance;
};

struct DrawRecord {  // attributes of one command, see shaders/visibility.vert.glsl
  float clip_x[4], clip_y[4], clip_w[4];
  std::uint32_t placed, unused;
  float clip_z[4];
};

// Buffers that hold the commands of one multi-draw.
class DrawList {
 public:
  DrawList(const Gl& gl, const GpuGeometry& geometry);

  void clear() { commands_.clear(), records_.clear(); }
  bool empty() const { return commands_.empty(); }
  std::size_t triangle_count() const;
  void add_record(const DrawRecord& record) { records_.push_back(record); }
  // A run of triangles with the record added last.
  void add_run(std::uint32_t first_index, std::uint32_t count);
  void draw();

 private:
  const Gl* gl_;
  std::vector<DrawCommand> commands_;
  std::vector<DrawRecord> records_;
  GlBuffer command_buffer_, record_buffer_;
  GlVertexArray array_;
};

class VisibilityPass {
 public:
  VisibilityPass(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
                 const VisibilityOptions& options);

  // Draws into textures of the image's size.
  void draw(const ViewProjection& view);

  const GlTexture& ids() const { return ids_; }      // placed mesh + 1, last vertex of its triangle
  const GlTexture& depth() const { return depth_; }  // near / Z
  const std::vector<float>& depth_values() const { return values_; }  // the same, read back

  // Two numbers a pixel, as ids().
  std::vector<std::uint32_t> read_ids() const;

  struct Counts {
    std::size_t triangles = 0, first_batch = 0;  // drawn; of these before any depth was known
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Candidate {
    std::uint32_t placed;
    std::uint32_t level;
    float distance;
  };
  void resize(int width, int height);
  void find_candidates(const ViewProjection& view);
  std::uint32_t choose_level(const PlacedMesh& piece, float z, double focal) const;
  // Adds the candidate's clusters that pass; `second`: those hidden last time but not by depth.
  void add_piece(const Candidate& candidate, const ViewProjection& view, const ViewVolume& volume,
                 bool second);
  void read_depth();

  const Gl& gl_;
  const PreparedScene& scene_;
  const GpuGeometry& geometry_;
  VisibilityOptions options_;
  GlProgram program_;
  DrawList list_;
  GlTexture ids_, depth_;
  GlFramebuffer target_;
  int width_ = 0, height_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<std::uint8_t> shown_;  // one a cluster flag: drawn in the next first batch
  std::vector<std::uint8_t> drawn_;  // in this frame
  bool have_history_ = false;
  DepthPyramid pyramid_;
  std::vector<float> values_;
  Counts counts_;
};

}  // namespace rubble
