#include "render/devices/gl/gl_light_watch.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "render/gl/gl_traffic.h"

namespace rubble {

namespace {

constexpr int kWatchGroup = 256, kWatchGroupsARow = 32768;  // local_size of the shader; a card takes 65,535 at least

std::string as_literal(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9e", double(value));
  return text;
}

}  // namespace

GlLightWatch::GlLightWatch(const Gl& gl, const WatchedPixels& pixels)
    : gl_(gl),
      pixels_(pixels.width * pixels.height),
      program_(make_compute_program(gl, "light_watch.comp.glsl", {{"DARK", as_literal(pixels.dark)}})),
      levels_(gl),
      thresholds_(gl),
      count_(gl),
      counts_back_(gl),
      changes_back_(gl) {
  bind_samplers(gl, program_, {{"radiance", 0}});
  std::vector<float> both(std::size_t(pixels_) * 2);
  for (std::size_t i = 0; i < std::size_t(pixels_); ++i) both[i * 2] = pixels.up[i], both[i * 2 + 1] = pixels.down[i];
  give_buffer(gl, thresholds_.name(), both.size() * sizeof(float), both.data(), GL_STATIC_DRAW);
  give_buffer(gl, levels_.name(), both.size() * sizeof(float), nullptr, GL_DYNAMIC_COPY);
  check_gl(gl, "making the pixels of an event camera");
}

std::vector<LightChange> GlLightWatch::see(const GlTexture& radiance) {
  // The card writes the list where the processor reads it: most of it stays empty.
  const auto changes = changes_back_.open(std::size_t(pixels_) * sizeof(LightChange));
  const std::uint32_t none = 0;
  give_buffer(gl_, count_.name(), sizeof none, &none, GL_STREAM_DRAW);
  GLuint binding = 0;
  for (const GLuint buffer : {levels_.name(), thresholds_.name(), count_.name(), changes->name()})
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer);
  gl_.BindTextureUnit(0, radiance.name());
  gl_.ProgramUniform1i(program_.name(), gl_.GetUniformLocation(program_.name(), "first_image"), first_);
  gl_.UseProgram(program_.name());
  const int groups = (pixels_ + kWatchGroup - 1) / kWatchGroup, row = std::min(groups, kWatchGroupsARow);
  gl_.DispatchCompute(GLuint(row), GLuint((groups + row - 1) / row), 1);
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  first_ = false;
  changes->sign();
  std::uint32_t count = 0;
  counts_back_.ask({{count_.name(), 0, sizeof count}})->take(&count);
  std::vector<LightChange> out(count);
  changes->take(out.data(), 0, count * sizeof(LightChange));
  check_gl(gl_, "finding which pixels of an event camera report");
  return out;
}

}  // namespace rubble
