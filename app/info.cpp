// `rubble info`: what this program and this machine are.
#include <cstdio>
#include <thread>

#include "app/build_info.h"
#include "app/commands.h"
#include "render/gl_context.h"

namespace rubble {

ExitCode print_info() {
  const BuildInfo build = build_info();
  std::printf("rubble        %s (%s)\n", build.version.c_str(), build.commit.c_str());
  std::printf("built with    %s, %s, for %s\n", build.compiler.c_str(), build.flags.c_str(),
              build.target.c_str());
  std::printf("threads       %u\n", std::thread::hardware_concurrency());
  for (const auto& [name, version] : build.libraries)
    std::printf("%-13s %s\n", name.c_str(), version.c_str());
  std::fflush(stdout);  // the versions are worth having even if EGL fails below
  const GlContext context;
  const GlInfo& info = context.info();
  std::printf("EGL           %s, %s\n", info.egl_version.c_str(), info.egl_device.c_str());
  std::printf("GL renderer   %s\n", info.renderer.c_str());
  std::printf("GL version    %s (%s)\n", info.version.c_str(), info.vendor.c_str());
  return ExitCode::done;
}

}  // namespace rubble
