#include "render/gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "kernel/base/error.h"
#include "render/gl.h"

#if defined(__SANITIZE_THREAD__)
// Drivers are built without the thread sanitizer, which then misses their locks and barriers.
extern "C" const char* __tsan_default_suppressions() {
  return "race:swrast_dri.so\nrace:libgallium\nrace:libEGL\nrace:libGLX\nrace:libnvidia\n";
}
#endif

namespace rubble {

namespace {

const char* const kInstallHint =
    "on Debian install libegl1, libegl-mesa0 and libgl1-mesa-dri (software or Mesa drivers), or "
    "the vendor's driver with its EGL library; RUBBLE_EGL_DEVICE=N chooses a device";

std::string egl_error_name(EGLint code) {
  switch (code) {
    case EGL_SUCCESS:
      return "no error reported";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
      return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      break;
  }
  char text[32];
  std::snprintf(text, sizeof text, "EGL error 0x%x", unsigned(code));
  return text;
}

// The entry points of libEGL, opened at run time.
struct Egl {
  PFNEGLGETPROCADDRESSPROC GetProcAddress = nullptr;
  PFNEGLGETERRORPROC GetError = nullptr;
  PFNEGLGETDISPLAYPROC GetDisplay = nullptr;
  PFNEGLINITIALIZEPROC Initialize = nullptr;
  PFNEGLTERMINATEPROC Terminate = nullptr;
  PFNEGLBINDAPIPROC BindAPI = nullptr;
  PFNEGLCREATECONTEXTPROC CreateContext = nullptr;
  PFNEGLDESTROYCONTEXTPROC DestroyContext = nullptr;
  PFNEGLMAKECURRENTPROC MakeCurrent = nullptr;
  PFNEGLQUERYSTRINGPROC QueryString = nullptr;
  // Extensions; absent where the driver lacks them.
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
};

template <typename F>
void find_symbol(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  if (!function) throw RunError(std::string("libEGL.so.1 has no ") + name + "; " + kInstallHint);
}

Egl load_egl() {
  // Never closed: drivers leave threads and thread-local state behind.
  void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    throw RunError(std::string("cannot draw: libEGL.so.1 does not load (") + (why ? why : "?") +
                   "); " + kInstallHint);
  }
  Egl egl;
  find_symbol(library, "eglGetProcAddress", egl.GetProcAddress);
  find_symbol(library, "eglGetError", egl.GetError);
  find_symbol(library, "eglGetDisplay", egl.GetDisplay);
  find_symbol(library, "eglInitialize", egl.Initialize);
  find_symbol(library, "eglTerminate", egl.Terminate);
  find_symbol(library, "eglBindAPI", egl.BindAPI);
  find_symbol(library, "eglCreateContext", egl.CreateContext);
  find_symbol(library, "eglDestroyContext", egl.DestroyContext);
  find_symbol(library, "eglMakeCurrent", egl.MakeCurrent);
  find_symbol(library, "eglQueryString", egl.QueryString);
  egl.GetPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      egl.GetProcAddress("eglGetPlatformDisplayEXT"));
  egl.QueryDevices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.GetProcAddress("eglQueryDevicesEXT"));
  egl.QueryDeviceString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      egl.GetProcAddress("eglQueryDeviceStringEXT"));
  return egl;
}

// One way to a display.
struct Candidate {
  std::string name;
  EGLenum platform = 0;  // 0: eglGetDisplay
  void* native = nullptr;
};

bool has_word(const char* list, const char* word) {
  return list && std::strstr(list, word) != nullptr;
}

std::vector<Candidate> find_devices(const Egl& egl, std::vector<bool>& is_software) {
  std::vector<Candidate> found;
  EGLDeviceEXT devices[32];
  EGLint count = 0;
  if (!egl.QueryDevices || !egl.GetPlatformDisplay || !egl.QueryDevices(32, devices, &count))
    return found;
  for (EGLint i = 0; i < count; ++i) {
    const char* extensions =
        egl.QueryDeviceString ? egl.QueryDeviceString(devices[i], EGL_EXTENSIONS) : nullptr;
    const bool software = has_word(extensions, "EGL_MESA_device_software");
    const char* file = has_word(extensions, "EGL_EXT_device_drm")
                           ? egl.QueryDeviceString(devices[i], EGL_DRM_DEVICE_FILE_EXT)
                           : nullptr;
    std::string name = "EGL device " + std::to_string(i) + " (";
    name += software ? "software" : (file ? file : "hardware");
    found.push_back({name + ")", EGL_PLATFORM_DEVICE_EXT, devices[i]});
    is_software.push_back(software);
  }
  return found;
}

int chosen_device(const GlContextOptions& options) {
  if (options.device >= 0) return options.device;
  const char* text = std::getenv("RUBBLE_EGL_DEVICE");
  if (!text || !*text) return -1;
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text, &end, 10);
  if (*end || errno || value < 0 || value > 1000)
    throw RunError(std::string("RUBBLE_EGL_DEVICE must be the number of an EGL device, found \"") +
                   text + "\"");
  return int(value);
}

std::vector<Candidate> list_candidates(const Egl& egl, int device) {
  std::vector<bool> software;
  const std::vector<Candidate> devices = find_devices(egl, software);
  if (device >= 0) {
    if (std::size_t(device) < devices.size()) return {devices[std::size_t(device)]};
    std::string known;
    for (const Candidate& d : devices) known += (known.empty() ? "" : ", ") + d.name;
    throw RunError("cannot draw: there is no EGL device " + std::to_string(device) +
                   "; EGL lists " + (known.empty() ? "none" : known) + "; " + kInstallHint);
  }
  std::vector<Candidate> order;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (!software[i]) order.push_back(devices[i]);
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (software[i]) order.push_back(devices[i]);
  if (egl.GetPlatformDisplay)
    order.push_back({"surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA, nullptr});
  order.push_back({"default display", 0, nullptr});
  return order;
}

}  // namespace

struct GlContext::State {
  Egl egl;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  Gl gl;
  GlInfo info;

  // Empty when it worked, else what failed.
  std::string try_open(const Candidate& candidate);
  std::string load_functions();
  void close();
};

void GlContext::State::close() {
  if (context != EGL_NO_CONTEXT) {
    egl.MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.DestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
  // The display is shared by all contexts of the process on it, so it is not terminated.
  display = EGL_NO_DISPLAY;
}

std::string GlContext::State::load_functions() {
#define RUBBLE_GL_LOAD(name, upper)                                               \
  gl.name = reinterpret_cast<PFNGL##upper##PROC>(egl.GetProcAddress("gl" #name)); \
  if (!gl.name) return "the driver has no gl" #name;
  RUBBLE_GL_FUNCTIONS(RUBBLE_GL_LOAD)
#undef RUBBLE_GL_LOAD
  const auto text = [&](GLenum what) {
    const GLubyte* s = gl.GetString(what);
    return std::string(s ? reinterpret_cast<const char*>(s) : "");
  };
  info.vendor = text(GL_VENDOR);
  info.renderer = text(GL_RENDERER);
  info.version = text(GL_VERSION);
  return info.renderer.empty() ? "the driver reports no renderer" : "";
}

std::string GlContext::State::try_open(const Candidate& candidate) {
  display = candidate.platform
                ? egl.GetPlatformDisplay(candidate.platform, candidate.native, nullptr)
                : egl.GetDisplay(EGL_DEFAULT_DISPLAY);
  if (display == EGL_NO_DISPLAY) return "no display: " + egl_error_name(egl.GetError());
  EGLint major = 0, minor = 0;
  if (!egl.Initialize(display, &major, &minor))
    return "cannot initialize: " + egl_error_name(egl.GetError());
  const char* extensions = egl.QueryString(display, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_KHR_surfaceless_context")) return "no EGL_KHR_surfaceless_context";
  if (!egl.BindAPI(EGL_OPENGL_API)) return "no desktop OpenGL: " + egl_error_name(egl.GetError());
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  context = egl.CreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT)
    return "no OpenGL 4.5 core context: " + egl_error_name(egl.GetError());
  if (!egl.MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    return "cannot make the context current: " + egl_error_name(egl.GetError());
  info.egl_device = candidate.name;
  const char* version = egl.QueryString(display, EGL_VERSION);
  info.egl_version = version ? version : "";
  return load_functions();
}

GlContext::GlContext(const GlContextOptions& options) : state_(std::make_unique<State>()) {
  if (options.threads > 0) setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 0);
  state_->egl = load_egl();
  std::string tried;
  for (const Candidate& candidate : list_candidates(state_->egl, chosen_device(options))) {
    const std::string failure = state_->try_open(candidate);
    if (failure.empty()) return;
    state_->close();
    tried += "\n  " + candidate.name + ": " + failure;
  }
  throw RunError("cannot draw: no EGL device gives an OpenGL 4.5 context. Tried:" + tried + "\n" +
                 kInstallHint);
}

GlContext::~GlContext() {
  if (state_) state_->close();
}

const GlInfo& GlContext::info() const { return state_->info; }
const Gl& GlContext::gl() const { return state_->gl; }

void GlContext::make_current() {
  const Egl& egl = state_->egl;
  egl.BindAPI(EGL_OPENGL_API);
  if (!egl.MakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context))
    throw RunError("cannot make the OpenGL context current: " + egl_error_name(egl.GetError()));
}

void GlContext::release() {
  state_->egl.MakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace rubble
