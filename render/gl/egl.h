// The entry points of libEGL, opened at run time, and the ways to a display. Internal to render/.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <vector>

namespace rubble {

struct Egl {
  PFNEGLGETPROCADDRESSPROC GetProcAddress = nullptr;
  PFNEGLGETERRORPROC GetError = nullptr;
  PFNEGLGETDISPLAYPROC GetDisplay = nullptr;
  PFNEGLINITIALIZEPROC Initialize = nullptr;
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

// Opens libEGL.so.1, or what the environment variable RUBBLE_EGL_LIBRARY names. Throws RunError: no
// library, or one without an entry point; with what to do.
Egl load_egl();

std::string egl_error_name(EGLint code);

// Whether a list of words separated by blanks, as EGL has them, holds this one; null: an empty list.
bool has_word(const char* list, const char* word);

// One way to a display.
struct EglCandidate {
  std::string name;        // as the driver calls it
  EGLenum platform = 0;    // 0: eglGetDisplay
  void* native = nullptr;  // EGLDeviceEXT; null: the default display
  int device = -1;         // number as EGL counts devices; -1: none
  bool software = false;   // draws on the processor
};

// Every way there is, in the order in which they are tried: devices that are hardware, devices that
// are software, the surfaceless platform, the default display.
std::vector<EglCandidate> list_egl_candidates(const Egl& egl);

// What on this machine decides how EGL fares: environment variables that are set, the drivers that
// libglvnd knows, device files that may not be opened. Lines, each with what to do about it.
std::vector<std::string> egl_circumstances();

// What to install, and how to choose.
extern const char* const kEglInstallHint;

}  // namespace rubble
