// What the window of a drive shows: colour, coloured depth and a map side by side, and words.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/image/image_file.h"
#include "render/scene/frame.h"

namespace rubble {

struct PictureLine {
  std::array<double, 2> from{}, to{};      // unit: pixel
  std::array<std::uint8_t, 3> colour{};    // red, green, blue
};

// A word in the colour of what it names.
struct PictureLabel {
  std::string text;                        // ASCII
  std::array<std::uint8_t, 3> colour{};    // red, green, blue
};

struct DrivePicture {
  const Frame* frame = nullptr;                  // with colour and depth; never null
  const RgbImage* map = nullptr;                 // square, as high as the frame; null: the colour pane alone is shown
  std::vector<std::array<double, 2>> track;      // where the camera was, in the map; unit: pixel
  std::array<double, 2> heading{1, 0};           // of the camera, in the map: right and down; length 1
  std::vector<PictureLine> lines;                // over the colour pane
  std::vector<PictureLabel> legend;              // of the lines, a row each, at the upper left
  std::vector<std::string> status;               // two lines below the panes; ASCII
  std::vector<std::array<std::string, 3>> help;  // rows over the colour pane; empty: none
  std::string notice;                            // over the colour pane; empty: none
};

// Size of the picture for frames of that size; unit: pixel
std::array<int, 2> drive_picture_size(int frame_width, int frame_height);
std::array<int, 2> inspect_picture_size(int frame_width, int frame_height);  // of the colour pane alone

RgbImage draw_drive_picture(const DrivePicture& picture);

}  // namespace rubble
