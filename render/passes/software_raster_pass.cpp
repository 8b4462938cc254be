// TriangleRaster by the processor, handed to the passes that follow as textures.
#include <cstring>

#include "render/passes/triangle_raster.h"

namespace rubble {

namespace {

class SoftwareRasterPass : public TriangleRaster {
 public:
  SoftwareRasterPass(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry,
                     int threads, bool textures)
      : gl_(gl), textures_(textures), raster_(scene, geometry.name_of_triangle, first_names(geometry), threads) {}

  void begin(const ViewProjection& view) override {
    const int width = view.intrinsics.width, height = view.intrinsics.height;
    if (textures_ && (width != width_ || height != height_)) {
      ids_ = make_target(gl_, GL_RG32UI, width, height);
      depth_ = make_target(gl_, GL_R32F, width, height);
      check_gl(gl_, "making the image buffers");
      width_ = width, height_ = height;
    }
    raster_.begin(view);
  }

  void draw(const std::vector<ClusterRun>& runs) override { raster_.draw(runs); }
  const std::vector<float>& depth_so_far() override { return raster_.depth(); }

  void finish() override {
    if (!textures_) return;
    gl_.TextureSubImage2D(ids_.name(), 0, 0, 0, width_, height_, GL_RG_INTEGER, GL_UNSIGNED_INT,
                          raster_.ids().data());
    gl_.TextureSubImage2D(depth_.name(), 0, 0, 0, width_, height_, GL_RED, GL_FLOAT,
                          raster_.depth().data());
    check_gl(gl_, "handing over the drawn triangles");
  }

  const std::vector<float>& depth_values() const override { return raster_.depth(); }
  const GlTexture& depth() const override { return depth_; }
  const GlTexture& ids() const override { return ids_; }

  std::vector<std::uint32_t> read_ids() const override {
    std::vector<std::uint32_t> out;
    out.reserve(raster_.ids().size() * 2);
    for (const std::uint64_t id : raster_.ids())
      out.push_back(std::uint32_t(id)), out.push_back(std::uint32_t(id >> 32));
    return out;
  }
  const std::uint32_t* id_values() const override {
    return reinterpret_cast<const std::uint32_t*>(raster_.ids().data());
  }

 private:
  static std::vector<std::uint32_t> first_names(const GpuGeometry& geometry) {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t index : geometry.first_index) out.push_back(index / 3);
    return out;
  }

  const Gl& gl_;
  bool textures_;
  SoftwareRaster raster_;
  GlTexture ids_, depth_;
  int width_ = 0, height_ = 0;
};

}  // namespace

std::unique_ptr<TriangleRaster> make_software_raster(const Gl& gl, const PreparedScene& scene,
                                                     const GpuGeometry& geometry, int threads, bool textures) {
  return std::make_unique<SoftwareRasterPass>(gl, scene, geometry, threads, textures);
}

}  // namespace rubble
