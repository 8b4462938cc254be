// What the functions that drive robots are told of sensors: who gets which sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"
#include "scripting/values/value.h"

namespace rubble {

// Whether the function of any robot is told of the sensor of that name: of a camera its depth, by colour_sense() its colours.
bool is_sensed(const Scenario& scenario, const std::string& name);

class RobotSenses {
 public:
  // scenario: must outlive this. start_ns: the stamp of the robots' time 0.
  RobotSenses(const Scenario& scenario, std::int64_t start_ns);

  // Numbers of the sensors that `senses` of any robot names.
  struct Sensed {
    std::vector<std::size_t> readings, depths, colours, imus;
  };
  Sensed sensed() const;

  // A frame has depth, or colours.
  void hear(const Sample& sample);
  // Adds the tables of kinds that scan, `cameras`, `images`, `imus` and `sensors` to what the robot's function is told: what was heard since its last
  // call.
  void tell(std::size_t robot, Value& told);

 private:
  std::string sense_of(const Sample& sample) const;

  const Scenario& scenario_;
  std::int64_t start_ns_;
  std::vector<std::string> camera_names_, imu_names_;
  std::vector<std::vector<std::shared_ptr<const Sample>>> untold_;  // by robot
};

}  // namespace rubble
