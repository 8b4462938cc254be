// Which ways to a display this machine has, and what on it decides how they fare.
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "render/gl/egl.h"

namespace rubble {

namespace {

namespace fs = std::filesystem;

EglCandidate describe_device(const Egl& egl, EGLDeviceEXT device, int number) {
  const char* extensions =
      egl.QueryDeviceString ? egl.QueryDeviceString(device, EGL_EXTENSIONS) : nullptr;
  const bool software = has_word(extensions, "EGL_MESA_device_software");
  const char* file = has_word(extensions, "EGL_EXT_device_drm")
                         ? egl.QueryDeviceString(device, EGL_DRM_DEVICE_FILE_EXT)
                         : nullptr;
  const std::string kind = software ? "software" : file ? file : "hardware";
  return {"EGL device " + std::to_string(number) + " (" + kind + ")", EGL_PLATFORM_DEVICE_EXT,
          device, number, software};
}

// Variables by which people steer libglvnd and Mesa, and what each does.
struct Variable {
  const char* name;
  const char* does;
};
constexpr Variable kVariables[] = {
    {"RUBBLE_EGL_LIBRARY", "this is opened instead of libEGL.so.1"},
    {"__EGL_VENDOR_LIBRARY_FILENAMES", "only these drivers are looked at"},
    {"__EGL_VENDOR_LIBRARY_DIRS", "drivers are looked for only there"},
    {"EGL_PLATFORM", "it steers Mesa's default display"},
    {"LIBGL_DRIVERS_PATH", "Mesa looks for its drivers only there"},
    {"GBM_BACKENDS_PATH", "Mesa looks for its back ends only there"},
    {"MESA_LOADER_DRIVER_OVERRIDE", "Mesa loads only this driver"},
    {"GALLIUM_DRIVER", "Mesa draws in software with only this driver"},
    {"LIBGL_ALWAYS_SOFTWARE", "Mesa draws in software"},
    {"MESA_GL_VERSION_OVERRIDE", "Mesa pretends to this version of OpenGL; 4.5 is needed"},
};

// NVIDIA's container runtime hands over the parts of the driver that this list names.
bool lacks_graphics(const char* capabilities) {
  const std::string list = capabilities ? capabilities : "all";
  return list.find("graphics") == std::string::npos && list.find("all") == std::string::npos;
}

std::string missing_path(const char* value) {
  std::string missing;
  const std::string list = value;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(':', from), list.size());
    const std::string path = list.substr(from, to - from);
    std::error_code ignored;
    if (!path.empty() && path[0] == '/' && !fs::exists(path, ignored)) missing = path;
    from = to + 1;
  }
  return missing;
}

std::size_t count_vendors() {
  std::size_t count = 0;
  for (const char* folder : {"/usr/share/glvnd/egl_vendor.d", "/etc/glvnd/egl_vendor.d"}) {
    std::error_code failed;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed))
      count += i->path().extension() == ".json";
  }
  return count;
}

void note_device_files(std::vector<std::string>& lines) {
  std::error_code failed;
  for (fs::directory_iterator i("/dev/dri", failed), end; !failed && i != end; i.increment(failed)) {
    const std::string path = i->path().string();
    if (path.find("renderD") == std::string::npos || access(path.c_str(), R_OK | W_OK) == 0) continue;
    lines.push_back(path + " cannot be opened (" + std::strerror(errno) +
                    "): add yourself to the group that owns it, mostly `render` or `video`");
  }
}

}  // namespace

std::vector<EglCandidate> list_egl_candidates(const Egl& egl) {
  std::vector<EglCandidate> hardware, software;
  EGLDeviceEXT devices[32];
  EGLint count = 0;
  if (egl.QueryDevices && egl.GetPlatformDisplay && egl.QueryDevices(32, devices, &count)) {
    for (EGLint i = 0; i < count; ++i) {
      const EglCandidate found = describe_device(egl, devices[i], i);
      (found.software ? software : hardware).push_back(found);
    }
  }
  std::vector<EglCandidate> order = hardware;
  order.insert(order.end(), software.begin(), software.end());
  if (egl.GetPlatformDisplay)
    order.push_back({"surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA});
  order.push_back({"default display"});
  return order;
}

std::vector<std::string> egl_circumstances() {
  std::vector<std::string> lines;
  for (const Variable& variable : kVariables) {
    const char* value = std::getenv(variable.name);
    if (!value || !*value) continue;
    std::string line = std::string(variable.name) + "=" + value + " is set: " + variable.does;
    const std::string missing = missing_path(value);
    if (!missing.empty()) line += "; there is no " + missing;
    lines.push_back(line + "; try without it");
  }
  const bool chosen = std::getenv("__EGL_VENDOR_LIBRARY_FILENAMES") ||
                      std::getenv("__EGL_VENDOR_LIBRARY_DIRS");
  if (!chosen && count_vendors() == 0)
    lines.push_back(
        "no driver is registered in /usr/share/glvnd/egl_vendor.d: install libegl-mesa0 or the "
        "vendor's driver; a container must be given the driver's EGL files too");
  const char* capabilities = std::getenv("NVIDIA_DRIVER_CAPABILITIES");
  if (lacks_graphics(capabilities))
    lines.push_back(std::string("NVIDIA_DRIVER_CAPABILITIES=") + capabilities +
                    " is set: NVIDIA's driver cannot draw in such a container; add `graphics`, or give `all`");
  note_device_files(lines);
  return lines;
}

}  // namespace rubble
