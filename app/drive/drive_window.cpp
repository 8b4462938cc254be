#include "app/drive/drive_window.h"

#include "app/drive/sdl.h"

#include <cstdlib>

#include "kernel/base/error.h"

namespace rubble {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return std::string(name) + (value && *value ? std::string("=") + value : " is not set");
}

[[noreturn]] void fail(const std::string& what, const std::string& why = sdl().GetError()) {
  std::string drivers;
  for (int i = 0; i < sdl().GetNumVideoDrivers(); ++i)
    drivers += (i ? ", " : "") + std::string(sdl().GetVideoDriver(i));
  throw RunError("a window is needed, and " + what + ": " + why +
                 "\n  SDL can use: " + drivers + "\n  " + variable("DISPLAY") + ", " +
                 variable("WAYLAND_DISPLAY") + ", " + variable("SDL_VIDEODRIVER") +
                 "\n  start it on a desktop, over `ssh -X`, or under `xvfb-run -a`; "
                 "`rubble run` needs no display");
}

}  // namespace

struct DriveWindow::State {
  SDL_Window* window = nullptr;
  SDL_Renderer* renderer = nullptr;
  SDL_Texture* texture = nullptr;
  int width = 0, height = 0;  // of the texture

  ~State() {
    if (texture) sdl().DestroyTexture(texture);
    if (renderer) sdl().DestroyRenderer(renderer);
    if (window) sdl().DestroyWindow(window);
    sdl().Quit();
  }
  void fit(int w, int h);
};

void DriveWindow::State::fit(int w, int h) {
  if (texture && w == width && h == height) return;
  if (texture) sdl().DestroyTexture(texture);
  texture = sdl().CreateTexture(renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING, w, h);
  if (!texture) fail("its picture cannot be made");
  sdl().RenderSetLogicalSize(renderer, w, h);
  width = w, height = h;
}

// Drawn by the processor: the graphics device's one context is the renderer's, and the picture is
// in memory anyway.
DriveWindow::DriveWindow(const std::string& title, int width, int height) {
  sdl().SetMainReady();
  sdl().SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  sdl().SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  sdl().SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  sdl().SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
  state_ = std::make_unique<State>();
  if (sdl().Init(SDL_INIT_VIDEO) != 0) fail("no display was found");
  // Where SDL finds no screen it may fall back on drawing nowhere.
  const std::string driver = sdl().GetCurrentVideoDriver();
  if ((driver == "offscreen" || driver == "evdev" || driver == "dummy") &&
      !std::getenv("SDL_VIDEODRIVER"))
    fail("no display was found", "only the driver \"" + driver + "\" starts, which shows nothing");
  sdl().InitSubSystem(SDL_INIT_GAMECONTROLLER);  // without one the keyboard has to do
  state_->window = sdl().CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                    width, height, SDL_WINDOW_RESIZABLE);
  if (!state_->window) fail("none can be opened");
  state_->renderer = sdl().CreateRenderer(state_->window, -1, SDL_RENDERER_SOFTWARE);
  if (!state_->renderer) fail("nothing can be drawn in it");
  sdl().RenderClear(state_->renderer);
  sdl().RenderPresent(state_->renderer);
}

DriveWindow::~DriveWindow() = default;

std::vector<std::string> DriveWindow::poll(Controls& controls) {
  std::vector<std::string> said;
  SDL_Event event;
  while (sdl().PollEvent(&event)) {
    std::string words = controls.handle(event);
    if (!words.empty()) said.push_back(std::move(words));
  }
  return said;
}

void DriveWindow::show(const RgbImage& image) {
  state_->fit(image.width, image.height);
  sdl().UpdateTexture(state_->texture, nullptr, image.rgb.data(), 3 * image.width);
  sdl().RenderClear(state_->renderer);
  sdl().RenderCopy(state_->renderer, state_->texture, nullptr, nullptr);
  sdl().RenderPresent(state_->renderer);
}

void DriveWindow::set_title(const std::string& title) {
  sdl().SetWindowTitle(state_->window, title.c_str());
}

}  // namespace rubble
