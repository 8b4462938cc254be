#include "render/devices/gl/lamp_fog_pass.h"

#include <algorithm>
#include <string>
#include <vector>

#include "render/gl/shader.h"
#include "render/lighting/lighting.h"

namespace rubble {

namespace {

constexpr GLuint kPointsAGroup = 64;   // local_size_x of the shaders, but for the check
constexpr int kRings = 3;       // of cells about what is lit, as AirTransfer::find_lit()
constexpr std::size_t kDirections = AirLinks::kDirections;
constexpr std::size_t kAirPoint = 80;  // size of the structure in shaders/fog_words.glsl; unit: byte

enum FogUnit { kRadiance, kLinkEnds, kFirstPlace, kSeenCorners, kNearest, kHidden };

// Mirrors the block in shaders/fog_words.glsl.
struct GridBlock {
  float origin[4] = {}, cell[4] = {};
  std::int32_t size[4] = {};
  float directions[kDirections][4] = {};
  float harmonics[kDirections][kHarmonics] = {};
  float light_reach = 0, lamp_reach = 0, tolerance = 0;
};
static_assert(kHarmonics == 16, "as in the shaders");

GridBlock make_block(const LampAir& air, float reach) {
  const AirLinks& links = *air.links;
  GridBlock block;
  for (int i = 0; i < 3; ++i) {
    block.origin[i] = links.grid.origin[i], block.cell[i] = links.grid.cell[i];
    block.size[i] = links.grid.size[std::size_t(i)];
  }
  block.size[3] = std::int32_t(links.grid.count());
  for (std::size_t k = 0; k < kDirections; ++k) {
    for (int i = 0; i < 3; ++i) block.directions[k][i] = links.directions[k][i];
    const Harmonics y = harmonics_of(links.directions[k]);
    std::copy(y.begin(), y.end(), block.harmonics[k]);
  }
  block.light_reach = kLightReach, block.lamp_reach = reach, block.tolerance = air.tolerance;
  return block;
}

// Two texels a point: what it scatters, by order; its extinction.
std::vector<float> table_of(const AirMatter& matter) {
  std::vector<float> out;
  for (std::size_t i = 0; i < matter.extinction.size(); ++i) {
    out.insert(out.end(), matter.scattered[i].begin(), matter.scattered[i].end());
    out.insert(out.end(), {matter.extinction[i], 0, 0, 0});
  }
  return out;
}

}  // namespace

LampFogPass::LampFogPass(const Gl& gl, const LampAir& air, float reach)
    : gl_(gl),
      points_(std::uint32_t(air.links->grid.count())),
      grid_(make_buffer(gl, std::vector<GridBlock>{make_block(air, reach)})),
      state_(gl),
      air_points_(gl),
      matter_(gl),
      total_(gl),
      emitted_(gl),
      ends_in_(gl),
      air_in_(gl),
      terms_(gl),
      stand_in_(gl),
      link_ends_(make_buffer(gl, air.links->ends)),
      first_place_(make_buffer(gl, air.links->first_place)),
      seen_corners_(make_buffer(gl, air.links->seen)),
      nearest_(make_buffer(gl, air.links->nearest)),
      hidden_(make_buffer(gl, air.links->hidden)) {
  const auto size = [&](const GlBuffer& buffer, std::size_t bytes) {
    give_buffer(gl_, buffer.name(), std::max<std::size_t>(bytes, 16), nullptr, GL_DYNAMIC_COPY);
  };
  const std::size_t linked = points_ * kDirections * 16;
  size(state_, 16), size(air_points_, points_ * kAirPoint), size(total_, points_ * 9 * 16), size(emitted_, linked);
  size(ends_in_, linked), size(air_in_, linked);
  size(terms_, 2 * points_ * sizeof(RadianceTerms)), size(stand_in_, 4 * points_);
  static_assert(sizeof(AirLinks::End) == 8, "the shaders read it as two words");
  link_ends_view_ = make_buffer_texture(gl, link_ends_, GL_RG32UI);
  first_place_view_ = make_buffer_texture(gl, first_place_, GL_R32UI);
  seen_corners_view_ = make_buffer_texture(gl, seen_corners_, GL_R8UI);
  nearest_view_ = make_buffer_texture(gl, nearest_, GL_R32UI);
  hidden_view_ = make_buffer_texture(gl, hidden_, GL_R32UI);
  terms_view_ = make_buffer_texture(gl, terms_, GL_RGB32F);
  stand_in_view_ = make_buffer_texture(gl, stand_in_, GL_R32UI);
  const auto make = [&](const char* file, const ShaderDefines& defines = {}) {
    GlProgram program = make_compute_program(gl, std::string("fog_") + file + ".comp.glsl", defines);
    bind_samplers(gl, program,
                  {{"radiance", kRadiance},
                   {"link_ends", kLinkEnds},
                   {"first_place", kFirstPlace},
                   {"seen_corners", kSeenCorners},
                   {"nearest", kNearest},
                   {"hidden", kHidden}});
    return program;
  };
  programs_.direct = make("direct"), programs_.begin = make("begin"), programs_.gather = make("gather");
  gl.UniformBlockBinding(programs_.direct.name(), gl.GetUniformBlockIndex(programs_.direct.name(), "Frame"), 0);
  for (int ring = 0; ring <= kRings; ++ring) programs_.lit[ring] = make("lit", {{"RING", std::to_string(ring)}});
  programs_.check = make("check"), programs_.emit = make("emit"), programs_.follow = make("follow");
  programs_.project = make("project"), programs_.sides = make("sides");
  check_gl(gl, "preparing the lamp's light in fog");
}

void LampFogPass::run(const GlProgram& program, GLuint groups_x, GLuint groups_y) {
  gl_.UseProgram(program.name());
  gl_.DispatchCompute(groups_x, groups_y, 1);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void LampFogPass::find(const LampAir& air, const Lamp& lamp) {
  if (matter_version_ != air.matter_version) {
    matter_version_ = air.matter_version;
    const std::vector<float> table = table_of(*air.matter);
    give_buffer(gl_, matter_.name(), table.size() * sizeof(float), table.data(), GL_DYNAMIC_DRAW);
  }
  if (!radiance_view_) radiance_view_ = make_buffer_texture(gl_, lamp.radiance_buffer, GL_RGBA32F);
  gl_.ClearNamedBufferData(state_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  const auto bind = [&](std::initializer_list<std::pair<GLuint, GLuint>> buffers) {
    for (const auto& [binding, buffer] : buffers) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
  };
  const GlTexture* views[] = {&radiance_view_,     &link_ends_view_, &first_place_view_,
                              &seen_corners_view_, &nearest_view_,   &hidden_view_};
  for (GLuint unit = 0; unit < 6; ++unit) gl_.BindTextureUnit(unit, views[unit]->name());
  bind({{3, grid_.name()}, {4, state_.name()}, {5, air_points_.name()}, {6, ends_in_.name()}, {7, air_in_.name()}});
  const GLuint groups = (points_ + kPointsAGroup - 1) / kPointsAGroup, directions = GLuint(kDirections);
  bind({{0, lamp.aim}, {1, lamp.seen}, {2, lamp.map}});
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, lamp.frame.name());
  run(programs_.direct, groups);
  bind({{0, matter_.name()}, {1, lamp.lit}});
  run(programs_.begin, groups);
  for (const GlProgram& ring : programs_.lit) run(ring, groups);
  const auto gather = [&] {
    bind({{0, total_.name()}});
    run(programs_.gather, groups);
    run(programs_.check, 1);
  };
  gather();
  for (int n = 0; n < air.most_iterations; ++n) {
    bind({{1, matter_.name()}, {2, emitted_.name()}});
    run(programs_.emit, groups, directions);
    bind({{1, lamp.lit}});
    run(programs_.follow, groups, directions);
    gather();
  }
  bind({{0, terms_.name()}});
  run(programs_.project, groups, 2);
  bind({{0, stand_in_.name()}});
  run(programs_.sides, groups);
  check_gl(gl_, "finding the lamp's light in fog");
}

}  // namespace rubble
