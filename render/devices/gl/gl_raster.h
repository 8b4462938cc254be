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
  std::size_t read_triangles() const override;
  void finish() override;

  const std::vector<float>& depth_values() const override;
  const std::uint32_t* ids() const override { return nullptr; }
  std::vector<std::uint32_t> read_ids() const override;
  std::unique_ptr<LeftImages> leave() override;

  // The same on the card.
  const GlTexture& depth_texture() const { return drawn_->plane_depth; }
  const GlTexture& id_texture() const { return drawn_->ids; }

 private:
  void prepare_to_draw();
  void add_record(std::uint32_t placed);
  void add_run(const ClusterRun& run);

  // The images of one view, and what of them is on its way back.
  struct Images {
    int width = 0, height = 0;
    GlTexture ids, depth, plane_depth;
    GlFramebuffer target, plane_target;
    std::shared_ptr<GlComing> values_coming, ids_coming, triangles_coming;
    std::vector<float> values;  // once they were taken
    bool values_taken = false;
  };
  class Left;
  std::shared_ptr<Images> make_images(int width, int height) const;
  void choose_images(int width, int height);
  void ask_ids(Images& images) const;
  const std::vector<float>& take_values(Images& images) const;
  std::vector<std::uint32_t> take_ids(Images& images) const;

  const Gl& gl_;
  const PreparedScene& scene_;
  const GlGeometry& geometry_;
  GlProgram program_, plane_program_;
  DrawList list_;
  std::unique_ptr<CullPass> cull_;  // null: not asked for
  GlBuffer block_;
  GlVertexArray empty_array_;
  const ViewProjection* view_ = nullptr;
  std::vector<std::shared_ptr<Images>> images_;  // those that nobody else has are free
  std::shared_ptr<Images> drawn_;                // one of them
  mutable GlReadback readback_;
  // ids: come back with the depth where those of the image before were asked for.
  mutable bool ids_wanted_ = false;
};

}  // namespace rubble
