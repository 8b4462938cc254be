#include "render/devices/gl/gl_colour_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/quick_math.h"
#include "render/colour/frame_fill.h"
#include "render/colour/view_lamp.h"
#include "render/devices/gl/coming_colours.h"
#include "render/devices/gl/colour_textures.h"
#include "render/devices/gl/gl_light_watch.h"
#include "render/gl/gl_traffic.h"
#include "render/gl/shader.h"
#include "render/materials/glass.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

ShaderDefines variant_of(const FrameLight& frame, const GlGeometry& geometry) {
  const auto& lights = frame.lights->lights;
  ShaderDefines defines = {{"LIGHT_COUNT", std::to_string(lights.size())}};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const ShadowViews::Light& shadow = frame.shadow->lights[i];
    defines.push_back({"LIGHT_" + std::to_string(i), std::to_string(int(lights[i].type)) + ", " +
                                                         std::to_string(shadow.first_view) + ", " +
                                                         std::to_string(shadow.views)});
  }
  defines.push_back({"SOIL", std::to_string(int(Pattern::soil)) + ".0"});
  if (!frame.clear_air) defines.push_back({"AIR", ""});
  defines.push_back({"AIR_STEPS", std::to_string(AirVolume::kSlices - 1) + ".0"});
  if (frame.wetness > 0) defines.push_back({"WET", ""});
  if (frame.glows) defines.push_back({"GLOW", ""});
  if (frame.surrounded) defines.push_back({"SURROUNDED", ""});
  if (frame.glass) defines.push_back({"GLASS", std::to_string(glass_appearance())});
  if (geometry.tables.paint_count > 0) {
    defines.push_back({"PAINTS", std::to_string(geometry.tables.paint_count)});
    defines.push_back({"PAINTED", std::to_string(find_surface_appearance(kPaintedAppearance))});
    defines.push_back({"PAINT_SIDE", std::to_string(geometry.tables.paint_side) + ".0"});
  }
  return defines;
}

constexpr std::size_t kExposureAt = offsetof(FrameBlock, view) / sizeof(float) + 1;  // in the block of the frame

enum Unit {
  kVisibility,
  kDepth,
  kVertices,
  kTriangles,
  kPlaced,
  kLight,
  kSurfaceAppearances,
  kShadow,
  kContact,
  kSky,
  kAir,
  kGround,
  kLensRays,
  kRowPoses,
  kPaint,
  kPaintImages,
  kShadowValues,
  kShadowEdges,
  kSunNumbers,
  kSunShares,
  kSunBlocks,
  kBehindUnit
};

GlProgram make_resolve_program(const Gl& gl, const ShaderDefines& defines) {
  GlProgram program = make_program(gl, "fullscreen.vert.glsl", "resolve.frag.glsl", defines);
  bind_samplers(gl, program,
                {{"visibility", kVisibility},
                 {"depth_values", kDepth},
                 {"vertex_table", kVertices},
                 {"triangle_table", kTriangles},
                 {"placed_table", kPlaced},
                 {"light_table", kLight},
                 {"look_textures", kSurfaceAppearances},
                 {"shadow_map", kShadow},
                 {"openness", kContact},
                 {"sky_map", kSky},
                 {"air_table", kAir},
                 {"ground_map", kGround},
                 {"lens_rays", kLensRays},
                 {"row_poses", kRowPoses},
                 {"paint_table", kPaint},
                 {"paint_images", kPaintImages},
                 {"sun_numbers", kSunNumbers},
                 {"sun_shares", kSunShares},
                 {"behind", kBehindUnit}});
  gl.UniformBlockBinding(program.name(), gl.GetUniformBlockIndex(program.name(), "Frame"), 0);
  return program;
}

}  // namespace

GlColourPass::GlColourPass(const Gl& gl, const GlGeometry& geometry, const GlRaster& raster,
                           const GlShadowPass& shadows, const std::unique_ptr<LampPass>& lit_by, const FrameLight& light,
                           const GroundMap& ground, const std::vector<PatternImage>& patterns)
    : gl_(gl),
      geometry_(geometry),
      raster_(raster),
      shadows_(shadows),
      lamp_(lit_by),
      frame_block_(gl),
      empty_array_(gl),
      contact_(gl),
      air_(gl),
      looks_(upload_surface_appearances(gl, patterns)),
      sky_map_(upload_sky(gl, light.lights->sky)),
      ground_map_(upload_ground(gl, ground)),
      ground_(ground),
      exposure_(make_compute_program(gl, "exposure.comp.glsl",
                                     {{"EXPOSURE_AT", std::to_string(kExposureAt)},
                                      {"KEY", std::to_string(kDisplayExposure.key)},
                                      {"DUSK", std::to_string(kDisplayExposure.dusk)}})),
      rgb_(gl),
      readback_(gl),
      texture_size_(patterns.front().size) {
  bind_samplers(gl, exposure_, {{"metered", 0}});
  defines_ = variant_of(light, geometry);
  if (shadows.edges())
    sun_ = std::make_unique<SunShadowPass>(gl, light.shadow->lights.front().views,
                                           SunShadowPass::Samplers{{"visibility", kVisibility},
                                                                   {"depth_values", kDepth},
                                                                   {"vertex_table", kVertices},
                                                                   {"triangle_table", kTriangles},
                                                                   {"placed_table", kPlaced},
                                                                   {"lens_rays", kLensRays},
                                                                   {"row_poses", kRowPoses},
                                                                   {"shadow_map", kShadow},
                                                                   {"shadow_values", kShadowValues},
                                                                   {"shadow_edges", kShadowEdges}},
                                           kSunBlocks);
}

const GlProgram& GlColourPass::program(int variant) {
  GlProgram& wanted = programs_[variant];
  if (!wanted) {
    ShaderDefines defines = defines_;
    if (variant & kLinear) defines.push_back({"LINEAR", ""});
    if (variant & kRays) defines.push_back({"RAYS", ""});
    if (variant & kLamp) defines.push_back({"LAMP", ""});
    if (variant & kMeter) defines.push_back({"METER", ""});
    if (variant & kSoftSun) defines.push_back({"SOFT_SUN", ""});
    if (variant & kBehind) defines.push_back({"BEHIND", ""});
    defines.push_back({"VEIL_FROM", std::to_string(kVeilFrom)});
    wanted = make_resolve_program(gl_, defines);
  }
  return wanted;
}

void GlColourPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  colour_ = make_target(gl_, GL_RGBA8, width, height);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, colour_.name(), 0);
  const std::size_t words = (std::size_t(width) * std::size_t(height) + 3) / 4 * 3;
  give_buffer(gl_, rgb_.name(), words * 4, nullptr, GL_STREAM_READ);
  check_gl(gl_, "making the colour buffer");
}

void GlColourPass::draw_with(int variant, const GlFramebuffer& target, const ViewProjection& view,
                             const Pose& world_from_camera, const SurfaceImages& surfaces,
                             const FrameLight& light, std::optional<float> exposure, bool anew,
                             const GlassLayer* layer) {
  const ViewLamp place = find_view_lamp(view, world_from_camera, light);
  const bool lamp = has_lamp(light);
  if (lamp) variant |= kLamp;
  if (anew) hand_over(view, surfaces);
  const GlTexture& ids = surfaces.in_raster ? raster_.id_texture() : ids_;
  const GlTexture& depth = surfaces.in_raster ? raster_.depth_texture() : depth_;
  if (anew && lamp) contact_.draw(view, depth, place.contact(lamp, light));
  const FrameBlock block =
      fill_frame_block(view, light, place.bearer, ground_, texture_size_, exposure.value_or(1));
  give_buffer(gl_, frame_block_.name(), sizeof block, &block, GL_STREAM_DRAW);
  if (!exposure) {
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, frame_block_.name());
    gl_.BindTextureUnit(0, metered_.name());
    gl_.UseProgram(exposure_.name());
    gl_.DispatchCompute(1, 1, 1);
    gl_.MemoryBarrier(GL_UNIFORM_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  const bool bounces = lamp_ && lamp_->is_lit();
  if (bounces) lamp_->find(frame_block_);
  if (anew) nodes_ = bounces ? &lamp_->light_of(ids, view.intrinsics.width, view.intrinsics.height) : &geometry_.light_view;
  if (light.air) {
    AirPass::Known known;
    if (bounces) known.lamp = lamp_->fog();
    if (surfaces.has_rays()) known.lens_rays = &lens_rays_, known.row_poses = &row_poses_;
    const bool tells = AirVolume::has_pixels(view.intrinsics.width, view.intrinsics.height);
    if (tells && !surfaces.depth_values && !surfaces.through_glass()) known.depth = &depth;
    air_.trace(*light.air, frame_block_, known);
  }
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  const GLuint textures[] = {ids.name(),
                             depth.name(),
                             geometry_.vertices_view.name(),
                             geometry_.triangles_view.name(),
                             geometry_.placed_view.name(),
                             nodes_->name(),
                             looks_.name(),
                             shadows_.depth().name(),
                             contact_.openness().name(),
                             sky_map_.name(),
                             air_.table().name(),
                             ground_map_.name()};
  for (GLuint unit = 0; unit < sizeof textures / sizeof textures[0]; ++unit)
    gl_.BindTextureUnit(unit, textures[unit]);
  if (surfaces.has_rays()) {
    gl_.BindTextureUnit(kLensRays, lens_rays_.name());
    gl_.BindTextureUnit(kRowPoses, row_poses_.name());
    variant |= kRays;
  }
  if (geometry_.tables.paint_count > 0) {
    gl_.BindTextureUnit(kPaint, geometry_.paint_view.name());
    gl_.BindTextureUnit(kPaintImages, geometry_.paint_images.name());
  }
  if (shown_behind_) {
    gl_.BindTextureUnit(kBehindUnit, shown_behind_->name());
    variant |= kBehind;
  }
  // What the exposure is found by needs no smooth shadows.
  if (sun_ && light.soft_sun && !(variant & kMeter)) draw_sun(view, surfaces), variant |= kSoftSun;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  const int every = variant & kMeter ? kMeterEvery : 1, width = view.intrinsics.width, height = view.intrinsics.height;
  gl_.Viewport(0, 0, (width + every - 1) / every, (height + every - 1) / every);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_.name());
  gl_.UseProgram(program(variant).name());
  gl_.Enable(GL_SCISSOR_TEST);
  // Of pixels `every` apart, the first at half of that: those before `end`.
  const auto count = [every](int end) { return std::max(0, end + every - 1 - every / 2) / every; };
  const int x0 = layer ? count(layer->x0) : 0, y0 = layer ? count(layer->y0) : 0;
  gl_.Scissor(x0, y0, count(layer ? layer->x1 : width) - x0, count(layer ? layer->y1 : height) - y0);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Disable(GL_SCISSOR_TEST);
}

// The images of the surfaces, where they are not on the card.
void GlColourPass::hand_over(const ViewProjection& view, const SurfaceImages& surfaces) {
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  if (width != given_width_ || height != given_height_) {
    given_width_ = width, given_height_ = height;
    ids_ = GlTexture(), depth_ = GlTexture(), lens_rays_ = GlTexture();
  }
  if (!surfaces.in_raster) {
    if (!ids_) ids_ = make_target(gl_, GL_RG32UI, width, height), depth_ = make_target(gl_, GL_R32F, width, height);
    give_image(gl_, ids_.name(), 0, {0, 0, 0, width, height}, GL_RG_INTEGER, GL_UNSIGNED_INT, surfaces.ids);
    give_image(gl_, depth_.name(), 0, {0, 0, 0, width, height}, GL_RED, GL_FLOAT, surfaces.depth_values->data());
  }
  if (surfaces.has_rays()) {
    if (!lens_rays_) {
      lens_rays_ = make_target(gl_, GL_RGBA32F, width, height), row_poses_ = make_target(gl_, GL_RGBA32F, 3, height);
      lens_ = surfaces.lens - 1;
    }
    if (lens_ != surfaces.lens)
      give_image(gl_, lens_rays_.name(), 0, {0, 0, 0, width, height}, GL_RGBA, GL_FLOAT, surfaces.ray_values);
    lens_ = surfaces.lens;
    give_image(gl_, row_poses_.name(), 0, {0, 0, 0, 3, height}, GL_RGBA, GL_FLOAT, surfaces.pose_values);
  }
  check_gl(gl_, "handing over the surfaces of a view");
}

// From the farthest on: a layer shows the one behind it. Leaves the outermost to be shown.
void GlColourPass::draw_behind(const ViewProjection& view, const Pose& world_from_camera,
                               const SurfaceImages& surfaces, const FrameLight& light) {
  shown_behind_ = nullptr;
  if (!surfaces.through_glass()) return;
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  behind_.clear();
  behind_.resize(surfaces.behind->size());
  for (std::size_t k = behind_.size(); k-- > 0;) {
    const GlassLayer& layer = (*surfaces.behind)[k];
    Behind& out = behind_[k];
    out.colour = make_target(gl_, GL_RGBA32F, width, height);
    out.target = GlFramebuffer(gl_);
    gl_.NamedFramebufferTexture(out.target.name(), GL_COLOR_ATTACHMENT0, out.colour.name(), 0);
    SurfaceImages images{layer.ids.data(), &layer.depth_values};
    images.ray_values = surfaces.ray_values, images.pose_values = surfaces.pose_values, images.lens = surfaces.lens;
    draw_with(kLinear, out.target, view, world_from_camera, images, light, 1, true, &layer);
    shown_behind_ = &out.colour;
  }
  check_gl(gl_, "drawing what is behind glass");
}

void GlColourPass::draw_sun(const ViewProjection& view, const SurfaceImages& surfaces) {
  gl_.BindTextureUnit(kShadowValues, shadows_.values().name());
  gl_.BindTextureUnit(kShadowEdges, shadows_.edges()->edges().name());
  sun_->draw(view.intrinsics.width, view.intrinsics.height, shadows_.edges()->pyramids(), surfaces.has_rays());
  gl_.BindTextureUnit(kSunNumbers, sun_->numbers().name());
  gl_.BindTextureUnit(kSunShares, sun_->shares().name());
}

void GlColourPass::draw_meter(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                              const FrameLight& light) {
  const auto count = [](int pixels) { return std::max(1, (pixels + kMeterEvery / 2 - 1) / kMeterEvery); };
  metered_ = make_target(gl_, GL_R32F, count(view.intrinsics.width), count(view.intrinsics.height));
  meter_target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(meter_target_.name(), GL_COLOR_ATTACHMENT0, metered_.name(), 0);
  const float none[4] = {-2000, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(meter_target_.name(), GL_COLOR, 0, none);
  draw_behind(view, world_from_camera, surfaces, light);
  draw_with(kMeter, meter_target_, view, world_from_camera, surfaces, light, 1);
  check_gl(gl_, "metering the image");
}

float GlColourPass::meter(const ViewProjection& view, const Pose& world_from_camera,
                          const SurfaceImages& surfaces, const FrameLight& light) {
  draw_meter(view, world_from_camera, surfaces, light);
  MeteredImage image;
  image.width = (view.intrinsics.width + kMeterEvery / 2 - 1) / kMeterEvery;
  image.height = (view.intrinsics.height + kMeterEvery / 2 - 1) / kMeterEvery;
  image.stops.resize(std::size_t(image.width) * std::size_t(image.height));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, meter_target_.name());
  take_pixels(gl_, image.width, image.height, GL_RED, GL_FLOAT, image.stops.data());
  return find_exposure(kDisplayExposure, image);
}

void GlColourPass::draw(const ViewProjection& view, const Pose& world_from_camera,
                        const SurfaceImages& surfaces, const FrameLight& light, std::optional<float> exposure,
                        bool metered) {
  resize(view.intrinsics.width, view.intrinsics.height);
  if (!exposure) {
    draw_meter(view, world_from_camera, surfaces, light);
  } else if (!metered) {
    draw_behind(view, world_from_camera, surfaces, light);
  }
  draw_with(0, target_, view, world_from_camera, surfaces, light, exposure, exposure && !metered);
}

std::unique_ptr<DrawnColours> GlColourPass::finish(const SurfaceImages& surfaces, bool smooth) {
  constexpr GLuint kPixelsAGroup = 256, kGroupsARow = 32768;
  GlProgram& program = finish_programs_[smooth];
  if (!program) {
    program = make_compute_program(gl_, "finish.comp.glsl", smooth ? ShaderDefines{{"SMOOTH", ""}} : ShaderDefines());
    bind_samplers(gl_, program, {{"colours", 0}, {"depth_values", 1}});
  }
  gl_.BindTextureUnit(0, colour_.name());
  gl_.BindTextureUnit(1, (surfaces.in_raster ? raster_.depth_texture() : depth_).name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, rgb_.name());
  gl_.UseProgram(program.name());
  const GLuint groups = (GLuint(width_) * GLuint(height_) + kPixelsAGroup - 1) / kPixelsAGroup, row = std::min(groups, kGroupsARow);
  gl_.DispatchCompute(row, (groups + row - 1) / row, 1);
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  auto coming = readback_.ask({{frame_block_.name(), kExposureAt * sizeof(float), sizeof(float)},
                               {rgb_.name(), 0, std::size_t(width_) * std::size_t(height_) * 3}});
  gl_.Flush();  // the card starts while the processor goes on
  check_gl(gl_, "drawing the colours");
  return std::make_unique<ComingColours>(std::move(coming));
}

// Into radiance_.
void GlColourPass::draw_radiance(const ViewProjection& view, const Pose& world_from_camera, const SurfaceImages& surfaces,
                                 const FrameLight& light) {
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  if (width != radiance_width_ || height != radiance_height_) {
    radiance_width_ = width, radiance_height_ = height;
    radiance_ = make_target(gl_, GL_RGBA32F, width, height);
    radiance_target_ = GlFramebuffer(gl_);
    gl_.NamedFramebufferTexture(radiance_target_.name(), GL_COLOR_ATTACHMENT0, radiance_.name(), 0);
  }
  draw_behind(view, world_from_camera, surfaces, light);
  draw_with(kLinear, radiance_target_, view, world_from_camera, surfaces, light, 1);
  check_gl(gl_, "drawing the linear image");
}

std::unique_ptr<DrawnRadiance> GlColourPass::draw_linear(const ViewProjection& view, const Pose& world_from_camera,
                                                         const SurfaceImages& surfaces, const FrameLight& light) {
  draw_radiance(view, world_from_camera, surfaces, light);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, radiance_target_.name());
  auto coming = readback_.ask(radiance_width_, radiance_height_, GL_RGBA, GL_FLOAT);
  gl_.Flush();  // the card starts while the processor goes on
  return std::make_unique<ComingRadiance>(std::move(coming));
}

std::unique_ptr<LightWatch> GlColourPass::make_light_watch(const WatchedPixels& pixels) {
  return std::make_unique<GlLightWatch>(gl_, pixels);
}

std::vector<LightChange> GlColourPass::draw_changes(const ViewProjection& view, const Pose& world_from_camera,
                                                    const SurfaceImages& surfaces, const FrameLight& light,
                                                    LightWatch& watch) {
  draw_radiance(view, world_from_camera, surfaces, light);
  return static_cast<GlLightWatch&>(watch).see(radiance_);
}

}  // namespace rubble
