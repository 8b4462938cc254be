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
  bool instance = false;        // see render/scene/frame.h
  bool label = false;           // likewise
  bool flow = false;            // likewise
  bool sky_visibility = false;  // likewise
  bool events = false;          // of an event camera
  bool imu = false;             // readings of an inertial unit
};

// What the numbers in Frame::label and Frame::instance stand for.
struct Legend {
  struct Piece {
    std::uint16_t label = 0;  // class, as in Frame::label
    std::string asset;        // name of its type
  };
  std::vector<std::string> labels;  // by label: "sky", "ground", then the assets
  std::vector<Piece> pieces;        // by piece number
};

// The legend as JSON: {"labels": [{"label", "name"}], "instances": [{"instance", "label", "name"}],
// "ground_instance", "no_instance"}.
std::string legend_to_json(const Legend& legend);

struct Recording {
  Channels channels;  // besides colour and depth
  Legend legend;  // with instance or label
  ImuModel imu;   // with imu
};

}  // namespace rubble
