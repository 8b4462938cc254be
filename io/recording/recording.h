// What is the same for every frame of a recording: which channels there are, and what their numbers
// mean.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/scene/frame.h"

namespace rubble {

// The optional channels of Frame that a recording holds. A recorder demands those that are set, of
// every frame, and leaves out the others.
struct Channels {
  bool right = false;           // Frame::rgb_right
  bool measured_depth = false;  // then the depth topics and files are what the sensor measures, and
                                // the exact depth goes where each format has its ground truth
  bool normals = false;
  bool instance = false;
  bool label = false;
  bool flow = false;
  bool sky_visibility = false;
  bool events = false;
  bool imu = false;
};

// What the numbers in Frame::label and Frame::instance stand for.
struct Legend {
  struct Piece {
    std::uint16_t label = 0;
    std::string asset;
  };
  std::vector<std::string> labels;  // by label: "sky", "ground", then the assets
  std::vector<Piece> pieces;        // by piece number
};

// The legend as JSON: {"labels": [{"label", "name"}], "instances": [{"instance", "label", "name"}],
// "ground_instance", "no_instance"}.
std::string legend_to_json(const Legend& legend);

struct Recording {
  Channels channels;
  Legend legend;  // with instance or label
  ImuModel imu;   // with imu
};

}  // namespace rubble
