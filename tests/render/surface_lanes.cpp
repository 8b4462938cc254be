// surface_model.glsl for lanes of pixels, compiled for each instruction set: see CMakeLists.txt.
#include "render/shading/wide_math.h"
#include "tests/render/surface_lanes.h"

namespace rubble::RUBBLE_ISA {

#define FN RUBBLE_INLINE
#include "tests/render/surface_case.glsl"
#undef FN

void answer_cases(const float* cases, std::size_t count, float* answers) {
  using namespace testing;
  static_assert(sizeof(SurfaceCase) == kCaseNumbers * sizeof(Real) && sizeof(SurfaceAnswer) == kAnswerNumbers * sizeof(Real));
  for (std::size_t first = 0; first < count; first += kWidth) {
    Real in[kCaseNumbers], out[kAnswerNumbers];
    for (int lane = 0; lane < kWidth; ++lane)
      for (int i = 0; i < kCaseNumbers; ++i) in[i][lane] = cases[std::min(first + std::size_t(lane), count - 1) * kCaseNumbers + std::size_t(i)];
    SurfaceCase one;
    std::memcpy(&one, in, sizeof one);
    const SurfaceAnswer found = answer(one);
    std::memcpy(out, &found, sizeof found);
    for (int lane = 0; lane < kWidth && first + std::size_t(lane) < count; ++lane)
      for (int i = 0; i < kAnswerNumbers; ++i) answers[(first + std::size_t(lane)) * kAnswerNumbers + std::size_t(i)] = out[i][lane];
  }
}

}  // namespace rubble::RUBBLE_ISA
