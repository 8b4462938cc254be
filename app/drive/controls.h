// From SDL's events to a DriveInput: keyboard, mouse and game controllers.
//
// Knows which keys are held and where the sticks are; a controller that is unplugged stops pushing.
// Events come from SDL_PollEvent; nothing here needs a window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/drive/drive_input.h"

union SDL_Event;

namespace rubble {

// One line of the help overlay and of docs/how_to/drive.md.
struct KeyHelp {
  const char* what;     // what it does, in a few words
  const char* keys;     // on the keyboard; empty: none
  const char* gamepad;  // on a gamepad; empty: none
};
const std::vector<KeyHelp>& all_key_help();

// Where the mouse is in the picture; unit: pixel.
struct Pointer {
  double x = 0, y = 0;
  bool pressed = false;            // its left button
  double press_x = 0, press_y = 0;  // where that went down last
};

// What the left button does: turn the camera, or pull at things while the right one turns it.
enum class LeftButton { looks, pulls };

class Controls {
 public:
  explicit Controls(LeftButton left = LeftButton::looks);
  ~Controls();
  Controls(const Controls&) = delete;
  Controls& operator=(const Controls&) = delete;

  // Opens a controller that was plugged in and lets go of one that is gone. What there is to say to
  // the person comes back; mostly nothing.
  std::string handle(const SDL_Event& event);
  // What is held now, and what has been asked since the last call.
  DriveInput take();
  // Lets go of all keys, as when the window loses the keyboard.
  void release_all();
  const Pointer& pointer() const;
  int gamepads() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
