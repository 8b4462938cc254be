#include "render/passes/resolve_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/gl/shader.h"
#include "render/materials/surface_appearance.h"
#include "render/passes/ray_pass.h"

namespace rubble {

namespace {

// Where the clean air begins to veil what is seen; unit: m.
constexpr double kVeilFrom = 12;
constexpr std::size_t kMostViews = 6 * kMostLights;

// Mirrors shaders/frame.glsl.
struct FrameBlock {
  float world_from_optical[3][4];
  float lens[4], view[4];
  float light_position[kMostLights][4], light_axis[kMostLights][4], light_colour[kMostLights][4];
  float lamp_position[4], lamp_axis[4], lamp_colour[4];
  float wetness[4];
  float sun_direction[4], sun_radiance[4], skyline[4];
  float ground[4], air_low[4], air_high[4], air_drops[4], balance[4];
  float shadow_rows[kMostViews * 4][4];
  float looks[kMaxSurfaceAppearances * 4][4];
};

void set(float (&out)[4], const Vec3f& v, float w = 0) {
  out[0] = v.x, out[1] = v.y, out[2] = v.z, out[3] = w;
}

bool has_lamp(const FrameLight& frame) {
  return frame.lamp.on && frame.lamp.intensity_cd > 0;
}

void fill_view(FrameBlock& block, const ViewProjection& view, float exposure) {
  const Mat3 r = view.world_from_optical.rotation.matrix();
  for (int i = 0; i < 3; ++i)
    set(block.world_from_optical[i], Vec3f(r.rows[i]),
        float(view.world_from_optical.translation[i]));
  const Intrinsics& k = view.intrinsics;
  set(block.lens, {float(1 / k.fx), float(1 / k.fy), float(k.cx)}, float(k.cy));
  set(block.view, {kNearPlane, exposure, float(k.width)}, float(k.height));
}

// A shift of the noise that hides the steps of 8 bits, by the bits of the pose: noise that stayed where
// it is while the camera moves would be a landmark. Range: 0 to 1023 pixels either way.
Vec3f grain_shift(const ViewProjection& view) {
  std::uint64_t hash = 0;
  const auto add = [&hash](double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    hash = (hash ^ bits ^ bits >> 32) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  };
  const Pose& pose = view.world_from_optical;
  for (int i = 0; i < 3; ++i) add(pose.translation[i]);
  for (const double x : {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z}) add(x);
  return {0, float(hash >> 40 & 1023u), float(hash >> 50 & 1023u)};
}

void fill_lights(FrameBlock& block, const FrameLight& frame) {
  const auto& lights = frame.lights->lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const LightModel& light = lights[i];
    set(block.light_position[i], light.position, frame.shadow->lights[i].texel);
    const bool beam = light.type == LightType::directional;
    set(block.light_axis[i], light.axis, beam ? frame.shadow->lights[i].far_texel : light.cos_outer);
    set(block.light_colour[i], light.colour,
        1 / std::max(light.cos_inner - light.cos_outer, 1e-6f));
  }
  for (std::size_t v = 0; v < frame.shadow->clip_from_world.size(); ++v)
    std::memcpy(block.shadow_rows[v * 4], frame.shadow->clip_from_world[v].data(),
                sizeof block.shadow_rows[0] * 4);
}

// What the size of the lamp adds to squares of distances.
float lamp_spread(const LampSpec& lamp) {
  const float r2 = float(lamp.size * lamp.size / 4);
  if (lamp.shape == LampShape::point) return 0;
  return lamp.shape == LampShape::ring ? r2 : 0.5f * r2;
}

// gloss_lobe() of shaders/surface.glsl at its highest that counts: seen and lit head-on.
float lobe_peak(float reflectance, float roughness) {
  return reflectance / (4 * roughness * roughness);
}

float grey_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

void fill_air_and_lamp(FrameBlock& block, const FrameLight& frame, const Pose& world_from_rig) {
  const double half = 0.5 * frame.lamp.cone_deg * portable::kPi / 180;
  set(block.lamp_position, Vec3f(world_from_rig * frame.lamp.position),
      lamp_spread(frame.lamp));
  set(block.lamp_axis, Vec3f(world_from_rig.rotation.rotate({1, 0, 0})),
      float(1 / (1 - portable::cos(half))));
  set(block.lamp_colour, lamp_colour(frame.lamp));
  const Sky& sky = frame.lights->sky;
  set(block.sun_direction, sky.sun_direction);
  set(block.sun_radiance, sky.sun_radiance);
  // Trees and roofs reflect about a tenth of what the sky and the sun give them.
  const LightModel& main = frame.lights->lights.front();
  const bool sunny = main.type == LightType::directional;
  set(block.skyline, sky.mean * 0.10f + (sunny ? main.colour * 0.02f : Vec3f()));
  set(block.balance, white_balance(*frame.lights));
}

void fill_fog(FrameBlock& block, const MeanFog& fog) {
  set(block.air_low, Vec3f(fog.box.min), float(fog.extinction));
  set(block.air_high, Vec3f(fog.box.max), fog.height > 0 ? float(1 / fog.height) : 0);
  set(block.air_drops, {float(fog.drops), float(fog.turned), 0});
}

void fill_surface_appearances(FrameBlock& block, int texture_size) {
  const std::vector<SurfaceAppearance>& looks = all_surface_appearances();
  for (std::size_t i = 0; i < looks.size() && i < kMaxSurfaceAppearances; ++i) {
    const SurfaceAppearance& l = looks[i];
    set(block.looks[i * 4], Vec3f(l.dark), 1 / l.tile);
    set(block.looks[i * 4 + 1], Vec3f(l.light), l.glow > 0 ? -l.glow : l.bump);
    set(block.looks[i * 4 + 2], Vec3f(l.accent), std::floor(255 * l.reflectance + 0.5f) + 0.99f * l.roughness);
    set(block.looks[i * 4 + 3], {float(l.pattern), l.dust, l.variation},
        std::log2(float(texture_size) / l.tile));
  }
}

ShaderDefines variant_of(const FrameLight& frame, const GpuGeometry& geometry) {
  const auto& lights = frame.lights->lights;
  ShaderDefines defines = {{"LIGHT_COUNT", std::to_string(lights.size())}};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const ShadowMap::Light& shadow = frame.shadow->lights[i];
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
  if (geometry.paint_count > 0) {
    defines.push_back({"PAINTS", std::to_string(geometry.paint_count)});
    defines.push_back({"PAINTED", std::to_string(find_surface_appearance(kPaintedAppearance))});
    defines.push_back({"PAINT_SIDE", std::to_string(geometry.paint_side) + ".0"});
  }
  return defines;
}

GlTexture upload_surface_appearances(const Gl& gl, const std::vector<PatternImage>& patterns) {
  const int size = patterns.front().size;
  GlTexture texture(gl, GLenum(GL_TEXTURE_2D_ARRAY));
  const int levels = int(std::lround(std::log2(size))) + 1;
  gl.TextureStorage3D(texture.name(), levels, GL_RGBA8, size, size, GLsizei(patterns.size()));
  for (std::size_t i = 0; i < patterns.size(); ++i)
    gl.TextureSubImage3D(texture.name(), 0, 0, 0, GLint(i), size, size, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, patterns[i].texels.data());
  gl.GenerateTextureMipmap(texture.name());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the textures");
  return texture;
}

GlTexture upload_sky(const Gl& gl, const Sky& sky) {
  GlTexture texture = make_target(gl, GL_RGB32F, sky.side, sky.side);
  gl.TextureSubImage2D(texture.name(), 0, 0, 0, sky.side, sky.side, GL_RGB, GL_FLOAT,
                       sky.map.data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the sky");
  return texture;
}

GlTexture upload_ground(const Gl& gl, const GroundMap& ground) {
  GlTexture texture = make_target(gl, GL_RG8, GroundMap::kSide, GroundMap::kSide);
  gl.TextureSubImage2D(texture.name(), 0, 0, 0, GroundMap::kSide, GroundMap::kSide, GL_RG,
                       GL_UNSIGNED_BYTE, ground.texels.data());
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl(gl, "uploading the map of the ground");
  return texture;
}

GlTexture make_air_table(const Gl& gl) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_3D));
  const GLuint name = texture.name();
  gl.TextureStorage3D(name, 1, GL_RGBA32F, AirVolume::kColumns, AirVolume::kRows,
                      AirVolume::kSlices);
  gl.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TextureParameteri(name, side, GL_CLAMP_TO_EDGE);
  check_gl(gl, "making the table of the air");
  return texture;
}

constexpr int kMeterEvery = 4;  // as METER in resolve.frag.glsl

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
  kSunBlocks
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
                 {"sun_shares", kSunShares}});
  gl.UniformBlockBinding(program.name(), gl.GetUniformBlockIndex(program.name(), "Frame"), 0);
  return program;
}

}  // namespace

float mirrored_peak(float reflectance, float roughness) {
  return reflectance > 0 ? lobe_peak(reflectance, roughness) : 0;
}

Vec3f lamp_colour(const LampSpec& lamp) {
  // White light-emitting diodes, a little cold; luminance 1 by Rec. 709 weights.
  const Vec3f tint(0.96f, 1.0f, 1.12f);
  return tint * float(lamp.intensity_cd * 1e-3 /
                      double(dot(tint, Vec3f(0.2126f, 0.7152f, 0.0722f))));
}

Vec3f white_balance(const LightSet& set) {
  const LightModel& main = set.lights.front();
  Vec3f light = set.sky.mean * portable::kPiF;
  if (main.type == LightType::directional) light += main.colour * std::max(-main.axis.z, 0.0f);
  // Under street lamps theirs is the light, as some metres below them.
  if (!set.far.empty()) light += set.far.front().colour * (1.0f / 50);
  const float bright = grey_of(light);
  if (bright <= 0) return {1, 1, 1};
  // Less at dusk, which is to look blue: 0.75 in daylight, 0.35 at 10 lx.
  const float adapted = std::clamp(0.35f + 0.1f * std::log10(bright * 100), 0.35f, 0.75f);
  const auto gain = [&](float c) { return 1 / (1 + adapted * (c / bright - 1)); };
  const Vec3f gains(gain(light.x), gain(light.y), gain(light.z));
  return gains * (1 / grey_of(gains));
}

ResolvePass::ResolvePass(const Gl& gl, const GpuGeometry& geometry, const FrameLight& light,
                         const GroundMap& ground, const std::vector<PatternImage>& patterns)
    : gl_(gl),
      geometry_(geometry),
      frame_block_(gl),
      empty_array_(gl),
      contact_(gl),
      looks_(upload_surface_appearances(gl, patterns)),
      sky_map_(upload_sky(gl, light.lights->sky)),
      air_table_(make_air_table(gl)),
      ground_map_(upload_ground(gl, ground)),
      ground_{ground.x, ground.y, 1 / ground.reach, 0},
      texture_size_(patterns.front().size) {
  defines_ = variant_of(light, geometry);
  if (light.shadow->edges)
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

const GlProgram& ResolvePass::program(int variant, TileContent content) {
  GlProgram& wanted = programs_[variant][int(content)];
  if (!wanted) {
    ShaderDefines defines = defines_;
    if (variant & kLinear) defines.push_back({"LINEAR", ""});
    if (variant & kRays) defines.push_back({"RAYS", ""});
    if (variant & kLamp) defines.push_back({"LAMP", ""});
    if (variant & kMeter) defines.push_back({"METER", ""});
    if (variant & kSoftSun) defines.push_back({"SOFT_SUN", ""});
    defines.push_back({"CONTENT", std::to_string(int(content))});
    defines.push_back({"VEIL_FROM", std::to_string(kVeilFrom)});
    wanted = make_resolve_program(gl_, defines);
  }
  return wanted;
}

void ResolvePass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  colour_ = make_target(gl_, GL_RGBA8, width, height);
  target_ = GlFramebuffer(gl_);
  gl_.NamedFramebufferTexture(target_.name(), GL_COLOR_ATTACHMENT0, colour_.name(), 0);
  check_gl(gl_, "making the colour buffer");
}

void ResolvePass::draw_with(int variant, const GlFramebuffer& target,
                            const ViewProjection& view, const Pose& world_from_camera,
                            const SurfaceImages& surfaces, const FrameLight& light,
                            float exposure, bool with_contact) {
  const ImageTiles tiles = tiles_of(view, surfaces);
  const bool all_light = variant & (kLinear | kMeter);
  const Pose& bearer = light.world_from_rig ? *light.world_from_rig : world_from_camera;
  const Vec3 lamp_place = light.world_from_rig
                              ? view.optical_from_world * (bearer * light.lamp.position)
                              : camera_from_optical.inverse() * light.lamp.position;
  const double lamp_offset = norm(light.world_from_rig ? lamp_place : light.lamp.position);
  const bool lamp =
      has_lamp(light) && (all_light || lamp_shows(light, lamp_offset, tiles, exposure));
  if (lamp) variant |= kLamp;
  if (with_contact)
    contact_.draw(view, surfaces.depth,
                  {lamp, Vec3f(lamp_place),
                   light.lamp.shape == LampShape::point ? 0.004f : float(light.lamp.size / 2)},
                  tiles.first_row, tiles.last_row);
  if (light.air_table)
    gl_.TextureSubImage3D(air_table_.name(), 0, 0, 0, 0, AirVolume::kColumns, AirVolume::kRows,
                          AirVolume::kSlices, GL_RGBA, GL_FLOAT, light.air_table->table().data());
  FrameBlock block{};
  fill_view(block, view, exposure);
  fill_lights(block, light);
  fill_air_and_lamp(block, light, bearer);
  fill_fog(block, light.fog);
  fill_surface_appearances(block, texture_size_);
  set(block.wetness, grain_shift(view) + Vec3f(float(light.wetness), 0, 0));
  std::memcpy(block.ground, ground_, sizeof ground_);
  gl_.NamedBufferData(frame_block_.name(), sizeof block, &block, GL_STREAM_DRAW);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  const GLuint textures[] = {surfaces.ids.name(),
                             surfaces.depth.name(),
                             geometry_.vertices_view.name(),
                             geometry_.triangles_view.name(),
                             geometry_.placed_view.name(),
                             geometry_.light_view.name(),
                             looks_.name(),
                             light.shadow->depth.name(),
                             contact_.openness().name(),
                             sky_map_.name(),
                             air_table_.name(),
                             ground_map_.name()};
  for (GLuint unit = 0; unit < sizeof textures / sizeof textures[0]; ++unit)
    gl_.BindTextureUnit(unit, textures[unit]);
  if (surfaces.lens_rays) {
    gl_.BindTextureUnit(kLensRays, surfaces.lens_rays->name());
    gl_.BindTextureUnit(kRowPoses, surfaces.row_poses->name());
    variant |= kRays;
  }
  if (geometry_.paint_count > 0) {
    gl_.BindTextureUnit(kPaint, geometry_.paint_view.name());
    gl_.BindTextureUnit(kPaintImages, geometry_.paint_images.name());
  }
  // What the exposure is found by needs no smooth shadows.
  if (sun_ && light.soft_sun && !(variant & kMeter) && draw_sun(view, surfaces, light)) variant |= kSoftSun;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  const int every = variant & kMeter ? kMeterEvery : 1;
  gl_.Viewport(0, 0, (view.intrinsics.width + every - 1) / every,
               (view.intrinsics.height + every - 1) / every);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.BindVertexArray(empty_array_.name());
  draw_tiles(variant, tiles, every);
}

// True where there are edges of its shadows.
bool ResolvePass::draw_sun(const ViewProjection& view, const SurfaceImages& surfaces, const FrameLight& light) {
  const Intrinsics& k = view.intrinsics;
  const ShadowMap& shadow = *light.shadow;
  const std::vector<EdgeBlock> blocks =
      find_edge_blocks(surfaces.lens_rays ? nullptr : &view, {surfaces.depth_values, k.width, k.height},
                       shadow.edge_layers(), Vec3(light.lights->lights.front().axis) * -1.0);
  if (blocks.empty()) return false;
  sun_->set_blocks(blocks, k.width, k.height);
  gl_.BindTextureUnit(kShadowValues, shadow.values.name());
  gl_.BindTextureUnit(kShadowEdges, shadow.edges->edges().name());
  sun_->draw(surfaces.lens_rays != nullptr);
  gl_.BindTextureUnit(kSunNumbers, sun_->numbers().name());
  gl_.BindTextureUnit(kSunShares, sun_->shares().name());
  return true;
}

ImageTiles ResolvePass::tiles_of(const ViewProjection& view, const SurfaceImages& surfaces) const {
  const Intrinsics& k = view.intrinsics;
  // The longest ray that reaches unit depth.
  const double x = std::max(k.cx + 0.5, k.width - k.cx) / k.fx;
  const double y = std::max(k.cy + 0.5, k.height - k.cy) / k.fy;
  const double longest =
      surfaces.lens_rays ? 1 / double(RayPass::kLeastCosine) : std::sqrt(1 + x * x + y * y);
  return cut_into_tiles(surfaces.depth_values, k.width, k.height,
                        float(double(kNearPlane) * longest / kVeilFrom));
}

// In daylight the lamp adds less than the image's steps can show.
bool ResolvePass::lamp_shows(const FrameLight& light, double lamp_offset,
                             const ImageTiles& tiles, float exposure) const {
  // Exposed radiance that moves the darkest of 8-bit values by a quarter, see shaders/tone.glsl.
  constexpr float kUnseen = 4e-4f;
  const Vec3f colour = lamp_colour(light.lamp);
  const float intensity = std::max(colour.x, std::max(colour.y, colour.z)) * exposure;
  if (tiles.nearest_value <= 0) return false;
  // Of albedo 1, and the peak of the mirrored part; of water, see surface.glsl.
  const float film = light.wetness > 0 ? lobe_peak(0.02f, 0.12f) : 0.0f;
  const float reflected = (1 + light.most_gloss + film) / float(portable::kPi);
  const float offset = float(lamp_offset);
  const float distance = std::max(kNearPlane / tiles.nearest_value - offset, 0.01f);
  return intensity * reflected / (distance * distance) > kUnseen;
}

void ResolvePass::draw_tiles(int variant, const ImageTiles& tiles, int every) {
  // Of pixels `every` apart, the first at half of that: those before `end`.
  const auto count = [every](int end) { return std::max(0, end + every - 1 - every / 2) / every; };
  gl_.Enable(GL_SCISSOR_TEST);
  const GlProgram* current = nullptr;
  for (const TileRun& run : tiles.runs) {
    const GlProgram& wanted = program(variant, run.content);
    if (current != &wanted) gl_.UseProgram(wanted.name());
    current = &wanted;
    const int x = count(run.x), y = count(run.y);
    gl_.Scissor(x, y, count(run.x + run.width) - x, count(run.y + run.height) - y);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_.Disable(GL_SCISSOR_TEST);
}

MeteredImage ResolvePass::meter(const ViewProjection& view, const Pose& world_from_camera,
                                const SurfaceImages& surfaces, const FrameLight& light) {
  const auto count = [](int pixels) { return (pixels + kMeterEvery / 2 - 1) / kMeterEvery; };
  MeteredImage out;
  out.width = count(view.intrinsics.width), out.height = count(view.intrinsics.height);
  const GlTexture texture = make_target(gl_, GL_R32F, std::max(1, out.width), std::max(1, out.height));
  const GlFramebuffer target(gl_);
  gl_.NamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  draw_with(kMeter, target, view, world_from_camera, surfaces, light, 1);
  out.stops.resize(std::size_t(out.width) * std::size_t(out.height));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target.name());
  gl_.ReadPixels(0, 0, out.width, out.height, GL_RED, GL_FLOAT, out.stops.data());
  check_gl(gl_, "metering the image");
  return out;
}

void ResolvePass::draw(const ViewProjection& view, const Pose& world_from_camera,
                       const SurfaceImages& surfaces, const FrameLight& light, float exposure,
                       bool metered) {
  resize(view.intrinsics.width, view.intrinsics.height);
  draw_with(0, target_, view, world_from_camera, surfaces, light, exposure, !metered);
}

void ResolvePass::read(std::vector<std::uint8_t>& rgba) {
  rgba.resize(std::size_t(width_) * std::size_t(height_) * 4);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target_.name());
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  check_gl(gl_, "reading the image back");
}

std::vector<float> ResolvePass::draw_linear(const ViewProjection& view,
                                            const Pose& world_from_camera,
                                            const SurfaceImages& surfaces,
                                            const FrameLight& light) {
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  const GlTexture texture = make_target(gl_, GL_RGBA32F, width, height);
  const GlFramebuffer target(gl_);
  gl_.NamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  draw_with(kLinear, target, view, world_from_camera, surfaces, light, 1);
  std::vector<float> out(std::size_t(width) * std::size_t(height) * 4);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target.name());
  gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, out.data());
  check_gl(gl_, "reading the linear image back");
  return out;
}

}  // namespace rubble
