#include "render/gl/gl_context.h"

#include <cstdlib>

#include "kernel/base/error.h"
#include "render/gl/egl.h"
#include "render/gl/gl.h"

#if defined(__SANITIZE_THREAD__)
// Drivers are built without the thread sanitizer, which then misses their locks and barriers.
extern "C" const char* __tsan_default_suppressions() {
  return "race:swrast_dri.so\nrace:libgallium\nrace:libEGL\nrace:libGLX\nrace:libnvidia\n";
}
#endif

namespace rubble {

namespace {

// Those that may be used, in the order in which they are tried.
std::vector<EglCandidate> candidates_for(const Egl& egl, int device) {
  const std::vector<EglCandidate> all = list_egl_candidates(egl);
  if (device < 0) return all;
  std::string known;
  for (const EglCandidate& candidate : all) {
    if (candidate.device == device) return {candidate};
    if (candidate.device >= 0) known += (known.empty() ? "" : ", ") + candidate.name;
  }
  throw RunError("cannot draw: there is no EGL device " + std::to_string(device) + "; EGL lists " +
                 (known.empty() ? "none" : known) + "; " + kEglInstallHint);
}

std::string why_chosen(const GlContextOptions& options, const EglCandidate& candidate,
                       const std::vector<std::string>& failed) {
  if (options.device >= 0) return "asked for by its number";
  if (failed.empty()) return candidate.software ? "no device is hardware" : "the first that works";
  return "the first that works, after " + std::to_string(failed.size()) + " that do not";
}

bool has_extension(const Gl& gl, const std::string& name) {
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
    if (const GLubyte* found = gl.GetStringi(GL_EXTENSIONS, GLuint(i)))
      if (name == reinterpret_cast<const char*>(found)) return true;
  return false;
}

struct NamedLimit {
  const char* name;
  GLenum code;
  GLint least;  // what the renderer needs; 0: any
};
constexpr NamedLimit kLimits[] = {{"texture size", GL_MAX_TEXTURE_SIZE, 4096},
                                  {"array texture layers", GL_MAX_ARRAY_TEXTURE_LAYERS, 24},
                                  {"texture buffer entries", GL_MAX_TEXTURE_BUFFER_SIZE, 0},
                                  {"texture units", GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, 16},
                                  {"uniform block bytes", GL_MAX_UNIFORM_BLOCK_SIZE, 16384}};

}  // namespace

struct GlContext::State {
  Egl egl;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  Gl gl;
  GlTraffic traffic;
  GlInfo info;

  // Empty when it worked, else what failed.
  std::string try_open(const EglCandidate& candidate);
  std::string read_limits();
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
  gl.traffic = &traffic;
#define RUBBLE_GL_LOAD(name, upper)                                               \
  gl.name = reinterpret_cast<PFNGL##upper##PROC>(egl.GetProcAddress("gl" #name)); \
  if (!gl.name) return "the driver has no gl" #name;
  RUBBLE_GL_FUNCTIONS(RUBBLE_GL_LOAD)
#undef RUBBLE_GL_LOAD
  gl.MultiDrawElementsIndirectCount = reinterpret_cast<PFNGLMULTIDRAWELEMENTSINDIRECTCOUNTARBPROC>(
      egl.GetProcAddress("glMultiDrawElementsIndirectCountARB"));
  const auto text = [&](GLenum what) {
    const GLubyte* s = gl.GetString(what);
    return std::string(s ? reinterpret_cast<const char*>(s) : "");
  };
  info.vendor = text(GL_VENDOR);
  info.renderer = text(GL_RENDERER);
  info.version = text(GL_VERSION);
  if (info.renderer.empty()) return "the driver reports no renderer";
  return read_limits();
}

std::string GlContext::State::read_limits() {
  info.limits.clear();
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45)
    return "OpenGL 4.5 is needed, the driver gives \"" + info.version + "\"";
  constexpr const char* kIndirect = "GL_ARB_indirect_parameters";
  if (!has_extension(gl, kIndirect) || !gl.MultiDrawElementsIndirectCount)
    return std::string("the driver has no ") + kIndirect + ", which OpenGL has from 4.6 on";
  for (const NamedLimit& limit : kLimits) {
    GLint value = 0;
    gl.GetIntegerv(limit.code, &value);
    if (value < limit.least)
      return std::string(limit.name) + ": at least " + std::to_string(limit.least) +
             " are needed, the driver has " + std::to_string(value);
    info.limits.push_back({limit.name, value});
  }
  return "";
}

std::string GlContext::State::try_open(const EglCandidate& candidate) {
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
  std::vector<std::string> failed;
  for (const EglCandidate& candidate : candidates_for(state_->egl, options.device)) {
    const std::string failure = state_->try_open(candidate);
    if (failure.empty()) {
      state_->info.why = why_chosen(options, candidate, failed);
      return;
    }
    state_->close();
    failed.push_back(candidate.name + ": " + failure);
  }
  std::string message = "cannot draw: no EGL device gives an OpenGL 4.5 context. Tried:";
  for (const std::string& line : failed) message += "\n  " + line;
  for (const std::string& line : egl_circumstances()) message += "\n" + line;
  throw RunError(message + "\n" + kEglInstallHint);
}

GlContext::~GlContext() {
  if (state_) state_->close();
}

const GlInfo& GlContext::info() const { return state_->info; }
const Gl& GlContext::gl() const { return state_->gl; }
const GlTraffic& GlContext::traffic() const { return state_->traffic; }

void GlContext::make_current() {
  const Egl& egl = state_->egl;
  egl.BindAPI(EGL_OPENGL_API);
  if (!egl.MakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context))
    throw RunError("cannot make the OpenGL context current: " + egl_error_name(egl.GetError()));
}

void GlContext::release() {
  state_->egl.MakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

GlReport report_gl() {
  GlReport report;
  for (const EglCandidate& candidate : list_egl_candidates(load_egl())) {
    GlContext::State state;
    state.egl = load_egl();
    std::string outcome = state.try_open(candidate);
    if (outcome.empty()) outcome = state.info.renderer + ", OpenGL " + state.info.version;
    state.close();
    report.candidates.push_back({candidate.name, outcome});
  }
  report.circumstances = egl_circumstances();
  return report;
}

}  // namespace rubble
