// The one source of how surfaces look, by all of its compilations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "kernel/base/random.h"
#include "render/gl/gl_context.h"
#include "render/gl/shader.h"
#include "render/shading/wide_shader.h"
#include "render/surface/scalar_surface.h"
#include "tests/render/surface_lanes.h"

namespace rubble::scalar {

#define FN inline
#include "tests/render/surface_case.glsl"
#undef FN

}  // namespace rubble::scalar

namespace rubble::testing {
namespace surface_model_test {

constexpr std::size_t kCases = 4096;

std::vector<float> make_cases() {
  RandomStream random(7, "tests.surface");
  std::vector<float> out(kCases * kCaseNumbers);
  for (float& x : out) x = float(random.next() >> 40) * 0x1p-24f;
  return out;
}

std::vector<float> answer_by_one(const std::vector<float>& cases) {
  std::vector<float> out(kCases * kAnswerNumbers);
  for (std::size_t i = 0; i < kCases; ++i) {
    scalar::SurfaceCase one;
    static_assert(sizeof one == kCaseNumbers * sizeof(float));
    std::memcpy(&one, &cases[i * kCaseNumbers], sizeof one);
    const scalar::SurfaceAnswer found = scalar::answer(one);
    std::memcpy(&out[i * kAnswerNumbers], &found, sizeof found);
  }
  return out;
}

std::vector<float> answer_by_lanes(const std::string& name, const std::vector<float>& cases) {
  std::vector<float> out(kCases * kAnswerNumbers);
#if defined(__x86_64__)
  if (name == "avx2") return avx2::answer_cases(cases.data(), kCases, out.data()), out;
  if (name == "avx512") return avx512::answer_cases(cases.data(), kCases, out.data()), out;
#endif
  plain::answer_cases(cases.data(), kCases, out.data());
  return out;
}

// A case a column, three numbers of its answer a row.
std::vector<float> answer_by_gl(const std::vector<float>& cases) {
  const GlContext context;
  const Gl& gl = context.gl();
  ExpandedShader shader = expand_shader("surface_words.glsl", {});  // with the models
  std::ifstream file(RUBBLE_SOURCE_DIR "/tests/render/surface_case.glsl");
  std::stringstream text;
  text << file.rdbuf();
  shader.text += text.str() + R"(
uniform samplerBuffer cases;
layout(location = 0) out vec4 colour;
vec3 three(int i) {
  int at = int(gl_FragCoord.x) * 36 + i * 3;
  return vec3(texelFetch(cases, at).x, texelFetch(cases, at + 1).x, texelFetch(cases, at + 2).x);
}
void main() {
  SurfaceAnswer a = answer(SurfaceCase(three(0), three(1), three(2), three(3), three(4), three(5), three(6), three(7),
                                       three(8), three(9), three(10), three(11)));
  int row = int(gl_FragCoord.y);
  colour = vec4(row == 0 ? a.albedo : row == 1 ? a.normal : row == 2 ? a.clear : row == 3 ? a.glow : row == 4 ? a.lobes : row == 5 ? a.shares : a.tone, 1.0);
}
)";
  const GlProgram program = make_program(gl, expand_shader("fullscreen.vert.glsl", {}), shader, "of the surface model");
  const GlBuffer buffer = make_buffer(gl, cases);
  const GlTexture table = make_buffer_texture(gl, buffer, GL_R32F);
  const int rows = kAnswerNumbers / 3;
  const GlTexture texture = make_target(gl, GL_RGBA32F, int(kCases), rows);
  const GlFramebuffer target(gl);
  gl.NamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  const GlVertexArray array(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  gl.Viewport(0, 0, int(kCases), rows);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(program.name());
  bind_samplers(gl, program, {{"cases", 0}});
  gl.BindTextureUnit(0, table.name());
  gl.BindVertexArray(array.name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<float> pixels(kCases * std::size_t(rows) * 4), out(kCases * kAnswerNumbers);
  gl.ReadPixels(0, 0, int(kCases), rows, GL_RGBA, GL_FLOAT, pixels.data());
  check_gl(gl, "asking a shader for surfaces");
  for (std::size_t i = 0; i < kCases; ++i)
    for (std::size_t k = 0; k < kAnswerNumbers; ++k)
      out[i * kAnswerNumbers + k] = pixels[(k / 3 * kCases + i) * 4 + k % 3];
  return out;
}

TEST(SurfaceModel, HasTheSameBitsForOnePointAndForLanes) {
  const std::vector<float> cases = make_cases(), one = answer_by_one(cases);
  for (const float x : one) ASSERT_TRUE(std::isfinite(x));
  for (const WideShader& set : wide_shaders()) {
    const std::vector<float> lanes = answer_by_lanes(set.name, cases);
    for (std::size_t i = 0; i < one.size(); ++i)
      ASSERT_EQ(std::memcmp(&one[i], &lanes[i], sizeof(float)), 0)
          << set.name << ", case " << i / kAnswerNumbers << ", number " << i % kAnswerNumbers << ": " << one[i] << " of one point, "
          << lanes[i] << " of lanes";
  }
}

TEST(SurfaceModel, IsTheSameOnACardWithinAStepOf8Bits) {
  const std::vector<float> cases = make_cases(), one = answer_by_one(cases), card = answer_by_gl(cases);
  std::size_t far = 0, varied = 0;
  std::string first;
  for (std::size_t c = 0; c < kCases; ++c) {
    int worst = -1;
    for (int k = 0; k < kAnswerNumbers; ++k) {
      const std::size_t i = c * kAnswerNumbers + std::size_t(k);
      // Lobes have no upper bound: they are compared relative to their own size.
      if (!(std::fabs(one[i] - card[i]) <= std::max(1.0f, std::fabs(one[i])) / 255)) worst = k;
      varied += c > 0 && std::fabs(one[i] - one[i - kAnswerNumbers]) > 0.02f;
    }
    if (worst < 0) continue;
    const std::size_t i = c * kAnswerNumbers + std::size_t(worst);
    if (++far == 1)
      first = "case " + std::to_string(c) + ", number " + std::to_string(worst) + ": " + std::to_string(one[i]) +
              " here, " + std::to_string(card[i]) + " there";
  }
  EXPECT_LE(double(far), 0.001 * double(kCases)) << first;
  EXPECT_GT(varied, one.size() / 3) << "the cases differ";
}

}  // namespace surface_model_test
}  // namespace rubble::testing
