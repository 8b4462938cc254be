// An OpenGL 4.5 core context that needs no display, by EGL.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace rubble {

struct Gl;

// What the context turned out to be, for `rubble info` and the manifest.
struct GlInfo {
  std::string vendor, renderer, version;  // as GL reports them
  std::string egl_device;                 // e.g. "device 0 (/dev/dri/card0)" or "surfaceless"
  std::string egl_version;
};

struct GlContextOptions {
  // Which EGL device to use, counted as EGL lists them; -1: the environment variable
  // RUBBLE_EGL_DEVICE if set, else the first that works, hardware before software.
  int device = -1;
  // Threads of a software rasteriser (0: its own choice). Used only when LP_NUM_THREADS is unset.
  int threads = 0;
};

// Owns the context and makes it current on the thread that constructs it. One thread at a time
// may draw; make_current() moves the context to another.
class GlContext {
 public:
  // Tries the EGL devices, then the surfaceless platform, then the default display. Throws
  // RunError that lists everything tried, with its error and what to install.
  explicit GlContext(const GlContextOptions& options = {});
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlInfo& info() const;
  void make_current();
  void release();        // so that another thread can take it
  const Gl& gl() const;  // for the passes inside render/

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
