// TriangleRaster by the graphics card. Internal to render/devices/gl.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/devices/gl/cull_pass.h"
#include "render/gl/gl_exchange.h"
#include "render/gl/shader.h"
#include "render/passes/triangle_raster.h"

namespace rubble {

class GlRaster : public TriangleRaster {
 public:
  // What they refer to must outlive it.
  GlRaster(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry);

  void begin(const ViewProjection& view) override;
  void draw(const std::vector<ClusterRun>& runs) override;
  bool draw_what_shows(const std::vector<DrawCandidate>& candidates) override;
  std::size_t read_triangles() const override { return cull_->read_triangles(); }
  void finish() override;

  const std::vector<float>& depth_values() const override;
  const std::uint32_t* ids() const override { return nullptr; }
  std::vector<std::uint32_t> read_ids() const override;

  // The same on the card.
  const GlTexture& depth_texture() const { return plane_depth_; }
  const GlTexture& id_texture() const { return ids_; }

 private:
  void resize(int width, int height);
  void prepare_to_draw();
  void add_record(std::uint32_t placed);
  void add_run(const ClusterRun& run);
  void ask_ids() const;

  const Gl& gl_;
  const PreparedScene& scene_;
  const GlGeometry& geometry_;
  GlProgram program_, plane_program_;
  DrawList list_;
  std::unique_ptr<CullPass> cull_;  // null: not asked for
  GlBuffer block_;
  GlVertexArray empty_array_;
  GlTexture ids_, depth_, plane_depth_;
  GlFramebuffer target_, plane_target_;
  int width_ = 0, height_ = 0;
  const ViewProjection* view_ = nullptr;
  mutable std::vector<float> values_;
  mutable bool values_asked_ = false;  // and not yet taken
  mutable GlReadback values_back_, ids_back_;
  // ids: come back with the depth where those of the image before were asked for.
  mutable bool ids_wanted_ = false;
  bool ids_asked_ = false;
};

}  // namespace rubble
