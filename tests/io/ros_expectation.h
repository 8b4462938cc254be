// A recording in ROS's terms and what it must hold, for readers in other languages.
#pragma once

#include "io/ros/ros_recorder.h"
#include "tests/io/support.h"

namespace rubble::test {

inline constexpr int kRosFrames = 4;

struct RosVariant {
  ros::Version version = ros::Version::ros1;
  RosDepth depth = RosDepth::millimetres;
  bool channels = false;  // every optional channel
};

RosOptions options_of(const RosVariant& variant);

// Writes kRosFrames frames to `recorder` and finishes it; into `folder`, what they hold:
// expected.json and the raw pictures `INDEX.CHANNEL`.
void record_and_expect(Recorder& recorder, const ScratchFolder& folder, const RosVariant& variant);

}  // namespace rubble::test
