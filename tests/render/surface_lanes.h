// The cases of surface_model_test.cpp, answered by each instruction set.
#pragma once

#include <algorithm>
#include <cstddef>

namespace rubble {

namespace testing {
inline constexpr int kCaseNumbers = 36, kAnswerNumbers = 21;
}

namespace plain {
void answer_cases(const float* cases, std::size_t count, float* answers);
}
#if defined(__x86_64__)
namespace avx2 {
void answer_cases(const float* cases, std::size_t count, float* answers);
}
namespace avx512 {
void answer_cases(const float* cases, std::size_t count, float* answers);
}
#endif

}  // namespace rubble
