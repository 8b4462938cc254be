// What is the same for every frame of a recording: which channels there are, and what their numbers
// mean.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"

namespace rubble {

// The optional channels of Frame that a recording holds. A recorder demands those that are set, of
// every frame, and leaves out the others.
struct Channels {
  bool right = false;           // Frame::rgb_right
  bool measured_depth = false;  // then the depth topics and files are what the sensor measures, and
                                // the exact depth goes where each format has its ground truth
  bool events = false;          // of an event camera
  bool imu = false;             // readings of an inertial unit
  StreamSet truth;              // images of ground truth, in the order of image_streams()

  // Whether one of them holds numbers of pieces or classes, which the legend explains.
  bool has_legend() const;
};

// What the numbers in the streams `label` and `instance` stand for.
struct Legend {
  struct Piece {
    std::uint16_t label = 0;  // class, as in the stream `label`
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
  Legend legend;  // where a stream of ground truth has one
  ImuModel imu;   // with imu
};

}  // namespace rubble
