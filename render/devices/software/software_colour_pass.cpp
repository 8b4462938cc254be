#include "render/devices/software/software_colour_pass.h"

#include <algorithm>
#include <cmath>

#include "render/colour/frame_fill.h"
#include "render/devices/software/openness_grids.h"
#include "render/colour/view_lamp.h"
#include "render/materials/glass.h"
#include "render/materials/surface_appearance.h"
#include "render/passes/antialias.h"
#include "render/shading/mip_images.h"

namespace rubble {

namespace {

constexpr float kNoEdge = 2;  // as SunEdges::blocks

struct FinishedColours : DrawnColours {
  std::vector<std::uint8_t> rgb;
  float exposure = 0;

  float take(std::vector<std::uint8_t>& out) override {
    out = std::move(rgb);
    return exposure;
  }
};

struct FinishedRadiance : DrawnRadiance {
  std::vector<float> values;

  std::vector<float> take() override { return std::move(values); }
};

class SoftwareColourPass : public ColourPass {
 public:
  SoftwareColourPass(const PreparedScene& scene, const SceneTables& tables, const SoftwareShadowMap& shadows,
                     const FrameLight& light, const GroundMap& ground, const std::vector<PatternImage>& patterns,
                     const WideShader& shader, ThreadPool& pool)
      : tables_(tables),
        shadows_(shadows),
        ground_(ground),
        texture_size_(patterns.front().size),
        looks_(TextureStack(patterns), int(patterns.size())),
        pool_(pool),
        shader_(shader) {
    if (!scene.placed.empty())
      data_.any_triangle = tables.names.name(scene.placed.front().mesh, 0);
    if (scene.paints) paints_ = PackedImages(scene.paints->images, scene.paints->image_count);
    fill_scene(light);
  }

  float meter(const ViewProjection& view, const Pose& world_from_camera,
              const SurfaceImages& surfaces, const FrameLight& light) override {
    const auto count = [](int pixels) { return (pixels + kMeterEvery / 2 - 1) / kMeterEvery; };
    MeteredImage out;
    out.width = count(view.intrinsics.width), out.height = count(view.intrinsics.height);
    out.stops.resize(std::size_t(out.width) * std::size_t(out.height));
    shade_behind(view, world_from_camera, surfaces, light);
    prepare(view, world_from_camera, surfaces, light, 1, Purpose::meter);
    ShadedPixels pixels;
    pixels.stops = out.stops.data(), pixels.width = out.width, pixels.height = out.height;
    shade(pixels);
    return find_exposure(kDisplayExposure, out);
  }

  void draw(const ViewProjection& view, const Pose& world_from_camera,
            const SurfaceImages& surfaces, const FrameLight& light, std::optional<float> exposure,
            bool metered) override {
    if (!exposure) exposure = meter(view, world_from_camera, surfaces, light), metered = true;
    exposure_ = *exposure;
    if (!metered) shade_behind(view, world_from_camera, surfaces, light);
    prepare(view, world_from_camera, surfaces, light, exposure_,
            metered ? Purpose::display_metered : Purpose::display);
    ShadedPixels pixels;
    pixels.width = data_.width, pixels.height = data_.height;
    display_.resize(std::size_t(data_.width) * std::size_t(data_.height) * 4);
    pixels.display = reinterpret_cast<std::uint32_t*>(display_.data());
    shade(pixels);
  }

  std::unique_ptr<DrawnColours> finish(const SurfaceImages& surfaces, bool smooth) override {
    auto out = std::make_unique<FinishedColours>();
    out->exposure = exposure_;
    if (smooth)
      smooth_edges(display_, *surfaces.depth_values, data_.width, data_.height, pool_, out->rgb);
    else
      copy_colours(display_, out->rgb);
    return out;
  }

  std::unique_ptr<DrawnRadiance> draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                             const SurfaceImages& surfaces, const FrameLight& light) override {
    shade_behind(view, world_from_camera, surfaces, light);
    prepare(view, world_from_camera, surfaces, light, 1, Purpose::linear);
    ShadedPixels pixels;
    pixels.width = data_.width, pixels.height = data_.height;
    auto out = std::make_unique<FinishedRadiance>();
    out->values.resize(std::size_t(data_.width) * std::size_t(data_.height) * 4);
    pixels.linear = out->values.data();
    shade(pixels);
    return out;
  }

 private:
  enum class Purpose { meter, display, display_metered, linear };

  // What is the same for all images.
  void fill_scene(const FrameLight& light) {
    data_.light_count = int(light.lights->lights.size());
    for (std::size_t i = 0; i < light.lights->lights.size(); ++i) {
      const ShadowViews::Light& shadow = light.shadow->lights[i];
      data_.lights[i] = {int(light.lights->lights[i].type), shadow.first_view, shadow.views};
    }
    data_.air = !light.clear_air, data_.wet = light.wetness > 0, data_.glow = light.glows;
    data_.surrounded = light.surrounded;
    if (light.glass) data_.glass_look = int(glass_appearance());
    data_.soil = float(int(Pattern::soil)), data_.veil_from = float(kVeilFrom);
    data_.paint_count = int(tables_.paint_count), data_.paint_side = tables_.paint_side;
    if (data_.paint_count > 0)
      data_.painted_look = int(find_surface_appearance(kPaintedAppearance));
    data_.looks = looks_.view(), data_.paints = paints_.view();
    data_.ground_map = ground_.texels.data(), data_.ground_side = GroundMap::kSide;
    const Sky& sky = light.lights->sky;
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    data_.sky_map = &sky.map.front().x, data_.sky_side = sky.side;
    data_.air_columns = AirVolume::kColumns, data_.air_rows = AirVolume::kRows,
    data_.air_slices = AirVolume::kSlices;
  }

  void prepare(const ViewProjection& view, const Pose& world_from_camera,
               const SurfaceImages& surfaces, const FrameLight& light, float exposure,
               Purpose purpose, const GlassLayer* layer = nullptr) {
    const ViewLamp lamp = find_view_lamp(view, world_from_camera, light);
    const float nearest = largest_of(*surfaces.depth_values);
    const bool all_light = purpose == Purpose::linear || purpose == Purpose::meter;
    data_.lamp =
        has_lamp(light) && (all_light || lamp_shows(light, lamp.offset, nearest, exposure));
    if (purpose != Purpose::display_metered)
      openness_.find(shader_, view, *surfaces.depth_values, lamp.contact(data_.lamp, light), layer ? layer->y0 : 0,
                     layer ? layer->y1 : view.intrinsics.height, pool_);
    data_.openness = openness_.view();
    if (!data_.openness.lamp) data_.lamp = false;  // it was found not to show
    data_.behind = surfaces.through_glass() ? behind_.front().data() : nullptr;
    data_.frame = fill_frame_block(view, light, lamp.bearer, ground_, texture_size_, exposure);
    data_.width = view.intrinsics.width, data_.height = view.intrinsics.height;
    data_.every = purpose == Purpose::meter ? kMeterEvery : 1;
    data_.ids = surfaces.ids, data_.depth_values = surfaces.depth_values->data();
    data_.lens_rays = surfaces.ray_values, data_.row_poses = surfaces.pose_values;
    data_.vertices = tables_.vertices.data(), data_.triangles = tables_.triangles.data();
    data_.placed = tables_.placed.data(), data_.paint = tables_.paint.data();
    data_.light = light.nodes->data();
    data_.air_table = light.air ? light.air->table(shader_, pool_).front().data() : nullptr;
    data_.shadow_map = shadows_.texels().data(), data_.shadow_side = light.shadow->side;
    // What the exposure is found by needs no smooth shadows.
    data_.sun_edges = {};
    if (light.soft_sun && !shadows_.edges().empty() && purpose != Purpose::meter)
      fill_edges(view, surfaces, light);
  }

  // The layers behind glass into behind_, the farthest first; a layer shows the one after it.
  void shade_behind(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                    const FrameLight& light) {
    if (!surfaces.through_glass()) return;
    const std::size_t size = surfaces.depth_values->size() * 4;
    behind_.resize(std::max(behind_.size(), surfaces.behind->size()));
    for (std::size_t k = surfaces.behind->size(); k-- > 0;) {
      const GlassLayer& layer = (*surfaces.behind)[k];
      SurfaceImages images{layer.ids.data(), &layer.depth_values};
      images.ray_values = surfaces.ray_values, images.pose_values = surfaces.pose_values;
      prepare(view, world_from_camera, images, light, 1, Purpose::linear, &layer);
      if (k + 1 < surfaces.behind->size()) data_.behind = behind_[k + 1].data();
      behind_[k].resize(size);
      ShadedPixels pixels;
      pixels.width = data_.width, pixels.height = data_.height;
      pixels.linear = behind_[k].data(), pixels.blocks = layer.blocks.data();
      shade(pixels);
    }
  }

  void fill_edges(const ViewProjection& view, const SurfaceImages& surfaces,
                  const FrameLight& light) {
    const std::vector<EdgeBlock> blocks = find_edge_blocks(
        surfaces.has_rays() ? nullptr : &view, {*surfaces.depth_values, data_.width, data_.height},
        light.shadow->edge_layers(shadows_.edges()), Vec3(light.lights->lights.front().axis) * -1.0, pool_);
    if (blocks.empty()) return;
    SunEdges& out = data_.sun_edges;
    out.blocks_across = (data_.width + kEdgeBlock - 1) / kEdgeBlock;
    edge_blocks_.assign(
        std::size_t(out.blocks_across) * std::size_t((data_.height + kEdgeBlock - 1) / kEdgeBlock),
        kNoEdge);
    for (const EdgeBlock& block : blocks)
      edge_blocks_[(block.place >> 16) * std::size_t(out.blocks_across) + (block.place & 65535)] =
          block.nearest;
    out.blocks = edge_blocks_.data();
    const std::vector<EdgePyramid>& pyramids = shadows_.edges();
    for (std::size_t i = 0; i < pyramids.size() && i < 2; ++i)
      out.tiles[i] = &pyramids[i].tiles().front().nearest;
    out.tiles_across = pyramids.front().side(), out.texels_a_tile = EdgeView::kTile;
    out.sun_radius = kSunRadius;
  }

  float largest_of(const std::vector<float>& values) {
    constexpr std::size_t kPart = 1 << 15;
    std::vector<float> parts((values.size() + kPart - 1) / kPart);
    pool_.run(int(parts.size()), 1, [&](int begin, int end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        const auto first = values.begin() + std::ptrdiff_t(i * kPart);
        parts[i] = *std::max_element(first, first + std::ptrdiff_t(std::min(kPart, values.size() - i * kPart)));
      }
    });
    return *std::max_element(parts.begin(), parts.end());
  }

  void shade(const ShadedPixels& pixels) {
    pool_.run((pixels.height + 3) / 4, 2,
              [&](int begin, int end) { shader_.shade(data_, pixels, begin, end); });
  }

  const SceneTables& tables_;
  const SoftwareShadowMap& shadows_;
  const GroundMap& ground_;
  int texture_size_;
  PackedImages looks_, paints_;
  ThreadPool& pool_;
  const WideShader shader_;
  OpennessGrids openness_;
  ShadingData data_;
  std::vector<float> edge_blocks_;
  std::vector<std::uint8_t> display_;  // four bytes a pixel
  float exposure_ = 0;  // of these
  std::vector<std::vector<float>> behind_;  // each glass, four a pixel, as ShadingData::behind
};

}  // namespace

std::unique_ptr<ColourPass> make_software_colour_pass(const PreparedScene& scene, const SceneTables& tables,
                                                      const SoftwareShadowMap& shadows, const FrameLight& light,
                                                      const GroundMap& ground, const std::vector<PatternImage>& patterns,
                                                      const WideShader& shader, ThreadPool& pool) {
  return std::make_unique<SoftwareColourPass>(scene, tables, shadows, light, ground, patterns, shader, pool);
}

}  // namespace rubble
