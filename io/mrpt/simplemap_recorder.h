// An MRPT .simplemap: the true poses of some key frames and what was seen from them, from which
// `observations2map` builds metric maps.
//
// A key frame comes when the camera has moved or turned enough since the last one. Each holds a
// CObservation3DRangeScan with a point cloud (observations2map takes nothing else) of the exact
// depth, or of the measured one where the recording has it, without pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

struct SimplemapOptions {
  double distance = 0.25;   // from key frame to key frame; unit: m; >= 0
  double angle_deg = 15;    // likewise; unit: degree; >= 0
  int points_across = 160;  // of a picture's width, the others are left out; range: > 0
  Recording recording;      // what is recorded, and under which names
  // The direction that a pixel looks in, in the optical frame, of any length with Z > 0; nothing
  // where the lens sees nothing. Not set: a pinhole without distortion.
  std::function<std::optional<Vec3>(double u, double v)> ray;
};

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_simplemap_recorder(const std::string& path,
                                                  const SimplemapOptions& options = {});

}  // namespace rubble
