#include "render/sensors/noise_field.h"

namespace rubble {

namespace plain {
extern const NoiseLanes kNoiseLanes;
}
#if defined(__x86_64__)
namespace avx2 {
extern const NoiseLanes kNoiseLanes;
}
namespace avx512 {
extern const NoiseLanes kNoiseLanes;
}
#endif

const std::vector<NoiseLanes>& noise_lanes() {
  static const std::vector<NoiseLanes> all = [] {
    std::vector<NoiseLanes> out;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) out.push_back(avx512::kNoiseLanes);
    if (__builtin_cpu_supports("avx2")) out.push_back(avx2::kNoiseLanes);
#endif
    out.push_back(plain::kNoiseLanes);
    return out;
  }();
  return all;
}

}  // namespace rubble
