// Bundled robots as registrations: a kind is the files scripting/robots/NAME*.cpp and its name in RUBBLE_ROBOTS
// (docs/development/contributing.md, "How to add a robot"). All that a program does with a robot beside its physics goes
// through this class: keys, model, commands, keys and sticks of a driver, what controllers are told.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/model/robot.h"
#include "scripting/robots/robot_item.h"
#include "scripting/values/value.h"

namespace rubble {

// What a person or a program asks of what is driven, in one step, whatever it was asked with.
struct TeleopCommand {
  // Held axes, range: -1 to 1. Turns are about X, Y and Z: positive rolls to the right, lowers the nose, turns left.
  double forward = 0, roll = 0, pitch = 0, yaw = 0;
  // Asked for in figures, besides. In the body frame (X forward, Y left, Z up); unit: m/s, rad/s
  Vec3 linear, angular;
  double speed = 0.3;  // of a robot at a full axis; unit: m/s
};

class RobotKind {
 public:
  virtual ~RobotKind() = default;

  virtual std::string name() const = 0;  // as `model` of a robot has it
  // Keys of `robots[]` and of `robots[].drive[]` that it adds; none.
  virtual std::unique_ptr<RobotFigures> figures() const { return nullptr; }
  virtual std::unique_ptr<RobotFigures> command_figures() const { return nullptr; }
  // Adds mistakes of a robot of this kind; key: "robots[1]."
  virtual void check(const RobotItem&, const std::string& key, std::vector<Diagnostic>&) const { (void)key; }
  virtual RobotModel make(const RobotItem& robot) const = 0;
  // Whether tracks or wheels at its sides drive it, which gives it odometry.
  virtual bool has_sides(const RobotItem&) const { return false; }

  // What a robot does that nobody asked for anything.
  virtual RobotLeg still(const RobotItem&) const { return {}; }
  // `joints` of the leg are asked for elsewhere. time: since the start; unit: s. Of any model: its sides alone.
  virtual RobotCommand command(const RobotModel& model, const RobotLeg& leg, double time) const;
  // Of a function of the script: its answer has `linear`, `angular`, `flippers` and these keys, all bound to the leg.
  virtual void add_answer_keys(RobotLeg&, Schema&) const {}
  virtual RobotCommand answer(const RobotModel& model, const RobotLeg& leg) const;
  // Of a driver: leg, the copy of `last` from leg.t on, gets what is asked for. seconds: since the step before.
  virtual void steer(const TeleopCommand& asked, const RobotItem& robot, const RobotLeg& last, double seconds, RobotLeg& leg) const;
  // What a function is told besides: of the robot, and in `truth`.
  virtual void tell(const RobotState&, Value& told, Value& truth) const { (void)told, (void)truth; }

 protected:
  static constexpr double kTurn = 1;  // of a full axis; unit: rad/s
  static double within(double value, double most);
};

// In the order of RUBBLE_ROBOTS, then of register_robot().
const std::vector<const RobotKind*>& robot_kinds();
// From outside of the tree; before missions are loaded. Throws InputError for a name that is taken.
void register_robot(std::unique_ptr<RobotKind> kind);

// Of a bundled robot, or the one of all robots from files.
const RobotKind& kind_of(const RobotItem& robot);
// A bundled robot with its defaults. Throws InputError with that key.
RobotItem make_robot_item(const std::string& kind, const std::string& key = "model");

}  // namespace rubble
