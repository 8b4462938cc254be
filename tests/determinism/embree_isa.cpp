// Preloaded before `rubble`: Embree uses the instruction set that RUBBLE_EMBREE_ISA names (sse2, sse4.2, avx, avx2,
// avx512), whatever the processor has.
#include <dlfcn.h>

#include <cstdlib>
#include <string>

extern "C" void* rtcNewDevice(const char* config) {
  using Function = void* (*)(const char*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  const char* const isa = std::getenv("RUBBLE_EMBREE_ISA");
  std::string all = config ? config : "";
  if (isa) all += std::string(all.empty() ? "isa=" : ",isa=") + isa;
  return real(all.c_str());
}
