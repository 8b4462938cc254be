#include "render/devices/gl/air_pass.h"

#include <algorithm>
#include <string>

#include "render/gl/shader.h"

namespace rubble {

namespace {

constexpr GLuint kLocalSide = 8;  // local_size_x and local_size_y of the shaders
constexpr std::size_t kRays = std::size_t(AirVolume::kColumns) * AirVolume::kRows;

// Mirrors the block in shaders/air_around.comp.glsl.
struct FieldBlock {
  float origin[4] = {}, cell[4] = {};
  std::int32_t size[4] = {};
  float open[kHarmonics][4] = {};
  std::int32_t has_lamp = 0, has_seen = 0, has_stand_in = 0, has_lamp_stand_in = 0, has_lamp_ends = 0;
};

GlTexture make_table(const Gl& gl) {
  GlTexture texture(gl, GLenum(GL_TEXTURE_3D));
  const GLuint name = texture.name();
  gl.TextureStorage3D(name, 1, GL_RGBA32F, AirVolume::kColumns, AirVolume::kRows, AirVolume::kSlices);
  gl.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TextureParameteri(name, side, GL_CLAMP_TO_EDGE);
  check_gl(gl, "making the table of the air");
  return texture;
}

GLuint groups(int count) { return (GLuint(count) + kLocalSide - 1) / kLocalSide; }

}  // namespace

AirPass::AirPass(const Gl& gl)
    : gl_(gl),
      block_(gl),
      wanted_(gl),
      noise_(gl),
      puffs_(gl),
      radiance_(gl),
      direct_(gl),
      near_glow_(gl),
      field_(gl),
      terms_(gl),
      lamp_terms_(gl),
      seen_(gl),
      stand_in_(gl),
      lamp_stand_in_(gl),
      around_(gl),
      least_(gl),
      found_wanted_(gl),
      table_(make_table(gl)) {}

const GlProgram& AirPass::program(bool around, bool rays) {
  GlProgram& wanted = programs_[around][rays];
  if (wanted) return wanted;
  ShaderDefines defines;
  if (rays) defines.push_back({"RAYS", ""});
  wanted = make_compute_program(gl_, around ? "air_around.comp.glsl" : "air_trace.comp.glsl", defines);
  bind_samplers(gl_, wanted, {{"lens_rays", 0}, {"row_poses", 1}, {"terms", 2}, {"lamp_terms", 3}});
  gl_.UniformBlockBinding(wanted.name(), gl_.GetUniformBlockIndex(wanted.name(), "Frame"), 0);
  return wanted;
}

// lamp_is_there: on the card, by itself.
void AirPass::give_field(const RadianceGrid& field, bool lamp_is_there) {
  FieldBlock block;
  for (int i = 0; i < 3; ++i) {
    block.origin[i] = field.grid.origin[i], block.cell[i] = field.grid.cell[i];
    block.size[i] = field.grid.size[std::size_t(i)];
  }
  block.size[3] = field.seen.cuts;
  for (std::size_t t = 0; t < kHarmonics; ++t)
    for (int c = 0; c < 3; ++c) block.open[t][c] = field.open[t][c];
  block.has_lamp = lamp_is_there || !field.of_lamp.empty(), block.has_seen = field.seen.seen.empty() ? 0 : 1;
  block.has_stand_in = field.stand_in.empty() ? 0 : 1;
  block.has_lamp_stand_in = lamp_is_there || !field.lamp_stand_in.empty();
  block.has_lamp_ends = lamp_is_there || !field.ends_of_lamp.empty();
  field_.give(&block, sizeof block);
  static_assert(sizeof(RadianceTerms) == kHarmonics * 3 * sizeof(float));
  terms_.give(field.terms);
  std::vector<RadianceTerms> of_lamp = field.of_lamp;
  if (!of_lamp.empty()) of_lamp.insert(of_lamp.end(), field.ends_of_lamp.begin(), field.ends_of_lamp.end());
  lamp_terms_.give(of_lamp);
  if (!terms_view_) {
    terms_view_ = make_buffer_texture(gl_, terms_.buffer(), GL_RGB32F);
    lamp_terms_view_ = make_buffer_texture(gl_, lamp_terms_.buffer(), GL_RGB32F);
  }
  std::vector<std::uint8_t> seen = field.seen.seen;  // whole words
  seen.resize((seen.size() + 3) / 4 * 4);
  seen_.give(seen);
  stand_in_.give(field.stand_in);
  lamp_stand_in_.give(field.lamp_stand_in);
}

void AirPass::find_wanted(const GlTexture& depth) {
  const ShaderDefines table{{"COLUMNS", std::to_string(AirVolume::kColumns)},
                            {"ROWS", std::to_string(AirVolume::kRows)},
                            {"SLICES", std::to_string(AirVolume::kSlices)},
                            {"FARTHEST", std::to_string(AirVolume::kFarthest)}};
  for (int last = 0; last < 2; ++last) {
    GlProgram& program = wanted_programs_[last];
    if (!program) {
      ShaderDefines defines = table;
      if (!last) defines.push_back({"LEAST", ""});
      program = make_compute_program(gl_, "air_wanted.comp.glsl", defines);
      bind_samplers(gl_, program, {{"depth_values", 0}});
      gl_.UniformBlockBinding(program.name(), gl_.GetUniformBlockIndex(program.name(), "Frame"), 0);
      for (const GlBuffer* buffer : {&least_, &found_wanted_})
        give_buffer(gl_, buffer->name(), kRays * 4, nullptr, GL_DYNAMIC_COPY);
    }
    gl_.BindTextureUnit(0, depth.name());
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, least_.name());
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, found_wanted_.name());
    gl_.UseProgram(program.name());
    gl_.DispatchCompute(groups(AirVolume::kColumns), groups(AirVolume::kRows), 1);
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
}

void AirPass::trace(const AirVolume& air, const GlBuffer& frame, const Known& known) {
  if (air.version() == traced_) return;
  traced_ = air.version();
  const AirTraceData& data = air.data();
  block_.give(static_cast<const AirBlock*>(&data), sizeof(AirBlock));
  if (!known.depth) wanted_.give(data.wanted, kRays * sizeof *data.wanted);
  if (data.billows > 0 && noise_of_ != data.noise) {
    noise_of_ = data.noise;
    noise_.give(data.noise, std::size_t(data.noise_side) * std::size_t(data.noise_side) * std::size_t(data.noise_side) * sizeof(float));
  }
  puffs_.give(data.puffs, std::size_t(data.puff_count) * sizeof *data.puffs);
  const std::size_t points = std::size_t(data.size[0]) * std::size_t(data.size[1]) * std::size_t(data.size[2]);
  radiance_.give(data.radiance, points * 4 * sizeof(float));
  direct_.give(data.direct, data.has_direct ? points * std::size_t(data.light_count) * 4 * sizeof(float) : 0);
  near_glow_.give(data.near_glow, data.has_near_glow ? std::size_t(data.near_glow_steps + 1) * kHarmonics * sizeof(float) : 0);
  const std::size_t entries = std::size_t(data.around_columns) * std::size_t(data.around_rows) * std::size_t(data.slices);
  gl_.NamedBufferData(around_.name(), GLsizeiptr(std::max<std::size_t>(entries * 6 * 16, 16)), nullptr, GL_DYNAMIC_COPY);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame.name());
  if (known.depth) find_wanted(*known.depth);
  const bool rays = known.lens_rays && known.row_poses;
  if (rays) gl_.BindTextureUnit(0, known.lens_rays->name()), gl_.BindTextureUnit(1, known.row_poses->name());
  const LampFogPass* lamp = known.lamp;
  const auto bind = [&](std::initializer_list<GLuint> buffers, GLuint first) {
    for (const GLuint buffer : buffers) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, first++, buffer);
  };
  bind({block_.name(), known.depth ? found_wanted_.name() : wanted_.name()}, 0);
  if (air.field()) {
    give_field(*air.field(), lamp != nullptr);
    bind({field_.name(), seen_.name(), stand_in_.name(), around_.name(),
          lamp ? lamp->stand_in_buffer().name() : lamp_stand_in_.name()}, 2);
    gl_.BindTextureUnit(2, terms_view_.name()), gl_.BindTextureUnit(3, (lamp ? lamp->terms() : lamp_terms_view_).name());
    gl_.UseProgram(program(true, rays).name());
    gl_.DispatchCompute(groups(data.around_columns), groups(data.around_rows), GLuint(data.slices - 1));
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  bind({noise_.name(), puffs_.name(), radiance_.name(), direct_.name(), around_.name(), near_glow_.name()}, 2);
  gl_.BindImageTexture(0, table_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  gl_.UseProgram(program(false, rays).name());
  gl_.DispatchCompute(groups(data.columns), groups(data.rows), 1);
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  check_gl(gl_, "finding the light in the air");
}

}  // namespace rubble
