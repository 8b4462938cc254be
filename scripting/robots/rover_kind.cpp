// The rover in missions.
#include "scripting/robots/robot_kind.h"
#include "scripting/robots/rover.h"

namespace rubble {
namespace {

class Rover : public RobotKind {
 public:
  std::string name() const override { return "rover"; }
  bool has_sides(const RobotItem&) const override { return true; }

  RobotModel make(const RobotItem& robot) const override {
    RoverOptions options;
    options.friction = robot.friction.value_or(options.friction);
    return make_rover(options);
  }
};

}  // namespace

std::unique_ptr<RobotKind> make_rover_kind() { return std::make_unique<Rover>(); }

}  // namespace rubble
