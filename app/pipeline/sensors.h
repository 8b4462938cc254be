// The sensors of a mission, ready to measure, each with its own rate and place on the rig.
#pragma once

#include <memory>
#include <vector>

#include "render/renderer.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// All sensors that ride on one rig, merged by stamp. At equal stamps inertial units come before
// cameras, and cameras in the order of all_cameras(). The renderer must outlive them.
class SensorSuite {
 public:
  // flown: the scenario with the path that is flown.
  SensorSuite(const Scenario& flown, Renderer& renderer, int threads);

  // Frames of each camera over the whole flight.
  const std::vector<int>& frames() const { return frames_; }
  int count_frames() const;
  // The sample that comes next. Nothing: every camera has given its last frame.
  std::optional<Sample> take();

 private:
  std::vector<int> frames_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
};

}  // namespace rubble
