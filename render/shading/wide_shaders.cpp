// Which of the compiled shadings this processor can run.
#include "kernel/base/error.h"
#include "render/shading/wide_shader.h"

namespace rubble {

namespace plain {
extern const WideShader kWideShader;
}
#if defined(__x86_64__)
namespace avx2 {
extern const WideShader kWideShader;
}
namespace avx512 {
extern const WideShader kWideShader;
}
#endif

const std::vector<WideShader>& wide_shaders() {
  static const std::vector<WideShader> all = [] {
    std::vector<WideShader> out;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      out.push_back(avx512::kWideShader);
    if (__builtin_cpu_supports("avx2")) out.push_back(avx2::kWideShader);
#endif
    out.push_back(plain::kWideShader);
    return out;
  }();
  return all;
}

const WideShader& find_wide_shader(const std::string& name) {
  const std::vector<WideShader>& all = wide_shaders();
  if (name.empty()) return all.front();
  std::string known;
  for (const WideShader& shader : all) {
    if (shader.name == name) return shader;
    known += (known.empty() ? "" : ", ") + std::string(shader.name);
  }
  throw RunError("this processor cannot shade with the instruction set " + name + "; it can with " +
                 known);
}

}  // namespace rubble
