// An OpenGL 4.5 core context that needs no display, by EGL.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rubble {

struct Gl;
struct GlTraffic;

// What the context turned out to be, for `rubble info` and the manifest.
struct GlInfo {
  std::string vendor, renderer, version;            // as GL reports them
  std::string egl_device;                           // e.g. "device 0 (/dev/dri/card0)" or "surfaceless"
  std::string egl_version;                          // as EGL states it
  std::string why;                                  // this device and no other was chosen
  std::vector<std::pair<std::string, int>> limits;  // names and values of those that matter here
};

struct GlContextOptions {
  // Which EGL device to use, counted as EGL lists them; -1: the first that works, hardware before software.
  int device = -1;
  // Threads of a software rasteriser (0: its own choice). Used only when LP_NUM_THREADS is unset.
  int threads = 0;
};

// What each way to a display gives, for `rubble info --gl`.
struct GlReport {
  struct Candidate {
    std::string name, outcome;  // the renderer and its version, or what failed
  };
  std::vector<Candidate> candidates;       // in the order in which they are tried
  std::vector<std::string> circumstances;  // what on this machine decides how they fare
};
// Opens each once. Throws RunError where libEGL itself is missing.
GlReport report_gl();

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
  const GlTraffic& traffic() const;

 private:
  friend GlReport report_gl();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
