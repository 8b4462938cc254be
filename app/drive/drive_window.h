// The window on the screen; the one place that talks to SDL's video side.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/drive/controls.h"
#include "io/image/image_file.h"

namespace rubble {

class DriveWindow {
 public:
  // Of that size at first; it can be resized, and what is shown is scaled. Throws RunError where
  // there is no display, saying what was tried and what to do.
  DriveWindow(const std::string& title, int width, int height);
  ~DriveWindow();
  DriveWindow(const DriveWindow&) = delete;
  DriveWindow& operator=(const DriveWindow&) = delete;

  // Hands every event that came to the controls; gives what there is to say to the person.
  std::vector<std::string> poll(Controls& controls);
  void show(const RgbImage& image);
  void set_title(const std::string& title);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Short texts with numbers, for the lines of a window.
// As printf() makes it; at most 239 characters.
template <typename... Values>
std::string words(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace rubble
