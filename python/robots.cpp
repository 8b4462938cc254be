// Bundled robots in a settled pile, stepped from Python.
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "app/control/robot_control.h"
#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/robot/robot_run.h"
#include "kernel/world/world_robots.h"
#include "python/parts.h"
#include "python/robot_commands.h"

namespace rubble::python {
namespace {

void expect(bool fine, const char* key, const char* message, const std::string& expected) {
  if (!fine) throw InputError({"", 0, key, message, expected, "", ""});
}

void expect_finite(const std::vector<double>& values, const char* key, const char* expected) {
  expect(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }), key, "not a finite number",
         expected);
}

RobotModel make_model(const std::string& name) {
  if (name == "snake") return make_snake();
  if (name == "crawler") return make_crawler();
  if (name == "rover") return make_rover();
  if (name == "vine") return make_vine();
  throw InputError({"", 0, "model", "unknown robot", "snake, crawler, rover or vine", "\"" + name + "\"", ""});
}

RobotRunOptions run_options(const Scenario& scenario, bool fixed_debris, int threads) {
  RobotRunOptions options = robot_run_options(scenario, threads);
  options.fixed_debris = fixed_debris;
  options.control_hz = 1 / options.step;  // commands count from the next step on
  options.track_hz = 0;
  return options;
}

class RobotWorld {
 public:
  RobotWorld(const SharedPile& settled, const std::string& model, const DoubleArray& pose, bool fixed_debris,
             int threads)
      : options_(run_options(settled->mission.scenario, fixed_debris, threads)),
        model_(make_model(model)),
        run_(make_laid_pile(settled->mission, settled->state), settled->state, options_) {
    run_.add(model_, to_pose(pose, "pose"), [this](const RobotSense&) { return command_; });
    run_.begin();
  }

  void drive(double linear, double angular, const std::vector<double>& flippers) {
    command_ = make_twist_command(model_, linear, angular, flippers);
  }
  void grow(double speed, double left, double up) { command_ = make_growth_command(model_, speed, left, up); }
  // The belts go on.
  void set_joints(const std::vector<double>& targets) { command_.joints = make_joints_command(model_, targets).joints; }

  void step(double seconds) {
    const int steps = count_steps(seconds, options_.step);
    if (refused_) throw *refused_;
    const py::gil_scoped_release free;
    try {
      for (int i = 0; i < steps; ++i) run_.step();
    } catch (const InputError& error) {
      Diagnostic d = error.diagnostics().front();
      d.key = "pose";
      refused_.emplace(d);
      throw *refused_;
    }
  }

  py::dict state() const { return describe_state(model_, run_.world().robots().state(0), run_.world().time()); }
  int joints() const { return int(model_.joints.size()); }
  std::vector<std::string> link_names() const { return link_names_of(model_); }

 private:
  RobotRunOptions options_;
  RobotModel model_;
  RobotRun run_;
  RobotCommand command_;
  std::optional<InputError> refused_;  // it has no room
};

}  // namespace

RobotCommand make_twist_command(const RobotModel& model, double linear, double angular,
                                const std::vector<double>& flippers) {
  expect(model.sides.any(), "drive", "this robot has neither tracks nor wheels", "crawler or rover");
  expect_finite({linear, angular}, "drive", "m/s and rad/s");
  const auto motors = std::size_t(std::count_if(model.joints.begin(), model.joints.end(),
                                                [](const RobotJoint& joint) { return joint.motor.effort > 0; }));
  const std::size_t wanted = model.sides.belts ? motors : 0;
  expect(flippers.empty() || flippers.size() == wanted, "flippers", "wrong number of angles",
         wanted ? std::to_string(wanted) + " or none" : "none");
  expect_finite(flippers, "flippers", "radians");
  return drive_sides(model, {linear, angular}, flippers);
}

RobotCommand make_growth_command(const RobotModel& model, double speed, double left, double up) {
  expect(model.tube.has_value(), "grow", "this robot does not grow", "vine");
  expect_finite({speed, left, up}, "grow", "a finite speed and finite curvatures");
  return drive_vine(model, {speed, left, up});
}

RobotCommand make_joints_command(const RobotModel& model, const std::vector<double>& targets) {
  expect(targets.size() == model.joints.size(), "targets", "wrong number of angles", std::to_string(model.joints.size()));
  expect_finite(targets, "targets", "radians");
  RobotCommand command;
  for (const double target : targets) command.joints.push_back({MotorMode::position, target});
  return command;
}

py::dict describe_state(const RobotModel& model, const RobotState& s, double time) {
  py::dict out;
  py::array_t<double> links = make_array<double>({py::ssize_t(s.links.size()), 7});
  for (std::size_t i = 0; i < s.links.size(); ++i) put_pose(s.links[i].world_from_link, links.mutable_data() + 7 * i);
  std::vector<double> angles, speeds, torques, forces;
  for (const RobotState::Joint& j : s.joints)
    angles.push_back(j.position), speeds.push_back(j.speed), torques.push_back(j.torque);
  for (const RobotState::Link& link : s.links)
    for (int k = 0; k < 3; ++k) forces.push_back(link.contact_force[k]);
  const auto joints = py::ssize_t(s.joints.size());
  out["time"] = time;
  out["links"] = links;
  out["joint_positions"] = take_vector(std::move(angles), {joints});
  out["joint_speeds"] = take_vector(std::move(speeds), {joints});
  out["joint_torques"] = take_vector(std::move(torques), {joints});
  out["contact_forces"] = take_vector(std::move(forces), {py::ssize_t(s.links.size()), 3});
  out["linear_velocity"] = from_vector(s.links[0].linear), out["angular_velocity"] = from_vector(s.links[0].angular);
  if (model.tube) out["length"] = s.length, out["tip_force"] = s.tip_force;
  out["lost"] = s.lost;
  return out;
}

std::vector<std::string> link_names_of(const RobotModel& model) {
  std::vector<std::string> names;
  for (const RobotLink& link : model.links) names.push_back(link.name);
  return names;
}

int count_steps(double seconds, double step) {
  expect(seconds > 0 && seconds <= 60, "seconds", "out of range", "more than 0, at most 60");
  return std::max(1, int(seconds / step + 0.5));
}

void add_robots(py::module_& module) {
  py::class_<RobotWorld>(module, "_RobotWorld")
      .def(py::init([](const SharedPile& s, const std::string& model, const DoubleArray& pose,
                       bool fixed_debris, int threads) {
        return std::make_unique<RobotWorld>(s, model, pose, fixed_debris, threads);
      }))
      .def("drive", &RobotWorld::drive, py::arg("linear"), py::arg("angular") = 0.0,
           py::arg("flippers") = std::vector<double>())
      .def("grow", &RobotWorld::grow, py::arg("speed"), py::arg("left") = 0.0, py::arg("up") = 0.0)
      .def("set_joints", &RobotWorld::set_joints, py::arg("targets"))
      .def("step", &RobotWorld::step, py::arg("seconds") = 1.0 / 60)
      .def("state", &RobotWorld::state)
      .def_property_readonly("joint_count", &RobotWorld::joints)
      .def_property_readonly("link_names", &RobotWorld::link_names);
}

}  // namespace rubble::python
