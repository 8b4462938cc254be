#include "render/gl/egl.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "kernel/base/error.h"

namespace rubble {

const char* const kEglInstallHint =
    "on Debian install libegl1, libegl-mesa0 and libgl1-mesa-dri (software or Mesa drivers), or "
    "the vendor's driver with its EGL library; `rubble info --gl` shows what each device says, "
    "--device gl:N or RUBBLE_DEVICE=gl:N chooses one";

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

namespace {

template <typename F>
void find_symbol(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  if (!function)
    throw RunError(std::string("cannot draw: the EGL library has no ") + name + "; " +
                   kEglInstallHint);
}

template <typename F>
void find_extension(const Egl& egl, const char* name, F& function) {
  function = reinterpret_cast<F>(egl.GetProcAddress(name));
}

}  // namespace

Egl load_egl() {
  const char* named = std::getenv("RUBBLE_EGL_LIBRARY");
  const char* name = named && *named ? named : "libEGL.so.1";
  // Never closed: drivers leave threads and thread-local state behind.
  void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    throw RunError(std::string("cannot draw: ") + name + " does not load (" + (why ? why : "?") +
                   "); " + kEglInstallHint);
  }
  Egl egl;
  find_symbol(library, "eglGetProcAddress", egl.GetProcAddress);
  find_symbol(library, "eglGetError", egl.GetError);
  find_symbol(library, "eglGetDisplay", egl.GetDisplay);
  find_symbol(library, "eglInitialize", egl.Initialize);
  find_symbol(library, "eglBindAPI", egl.BindAPI);
  find_symbol(library, "eglCreateContext", egl.CreateContext);
  find_symbol(library, "eglDestroyContext", egl.DestroyContext);
  find_symbol(library, "eglMakeCurrent", egl.MakeCurrent);
  find_symbol(library, "eglQueryString", egl.QueryString);
  find_extension(egl, "eglGetPlatformDisplayEXT", egl.GetPlatformDisplay);
  find_extension(egl, "eglQueryDevicesEXT", egl.QueryDevices);
  find_extension(egl, "eglQueryDeviceStringEXT", egl.QueryDeviceString);
  return egl;
}

bool has_word(const char* list, const char* word) {
  const std::size_t length = std::strlen(word);
  for (const char* at = list; at && (at = std::strstr(at, word)); at += length) {
    const bool begins = at == list || at[-1] == ' ';
    if (begins && (at[length] == ' ' || at[length] == 0)) return true;
  }
  return false;
}

}  // namespace rubble
