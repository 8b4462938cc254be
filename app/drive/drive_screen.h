// What a person sees of `rubble drive` and `rubble inspect`: the window, what is said over its picture, and how fast time goes.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "app/drive/controls.h"
#include "app/drive/drive_window.h"
#include "io/image/drive_picture.h"

namespace rubble {

class DriveScreen {
 public:
  // program: "drive" or "inspect". Throws as DriveWindow does.
  DriveScreen(const std::string& program, int width, int height);

  void set_title(const std::string& text);  // after the program's name
  void poll(Controls& controls);            // hands it every event; says what there is to say
  void say(const std::string& text);        // to stderr and, for some seconds, over the picture
  // With what was said last, or with these keys in its place. help: null: no help
  void show(DrivePicture& picture, const std::vector<KeyHelp>* help);
  // What was shown last, to FOLDER/picture_NNN.png.
  void save_picture(const std::string& folder);

 private:
  std::string program_;
  DriveWindow window_;
  RgbImage shown_;
  int pictures_ = 0;
  std::string notice_;
  std::chrono::steady_clock::time_point notice_until_;
};

// How a person lets time go.
struct ViewPace {
  bool paused = false;
  bool one_step = false;  // although it is paused
  int slowness = 1;       // of time: 1, 4 or 16

  // Whether the action is one of these: pause, one_step, slow.
  bool act(DriveAction action);
  // For the status line; "": as always.
  const char* describe() const;
};

}  // namespace rubble
