// Robots in a settled pile, stepped one control period at a time.
#include <pybind11/stl.h>

#include <algorithm>

#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/world/world.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

constexpr double kStep = 1.0 / 240;  // unit: s; as RobotRunOptions
constexpr int kSubsteps = 4;
constexpr double kMostDepth = 0.005;  // unit: m; as RobotRun: deeper, and it cannot be put there

constexpr std::size_t kFlippers = 4;  // of a crawler

enum class Kind { snake, crawler, rover, vine };

Kind kind_named(const std::string& name) {
  if (name == "snake") return Kind::snake;
  if (name == "crawler") return Kind::crawler;
  if (name == "rover") return Kind::rover;
  if (name == "vine") return Kind::vine;
  throw InputError({"", 0, "model", "unknown robot", "snake, crawler, rover or vine", "\"" + name + "\"", ""});
}

RobotModel make_model(Kind kind) {
  switch (kind) {
    case Kind::snake:
      return make_snake();
    case Kind::crawler:
      return make_crawler();
    case Kind::rover:
      return make_rover();
    case Kind::vine:
      break;
  }
  return make_vine();
}

WorldOptions world_options(const Scenario& s, int threads) {
  WorldOptions options;
  options.gravity = s.settle.gravity;
  options.lost_below = s.settle.lost_below, options.lost_beyond = s.settle.lost_beyond;
  options.threads = threads;
  return options;
}

class RobotWorld {
 public:
  RobotWorld(const SharedPile& settled, const std::string& model, const DoubleArray& pose, bool fixed_debris,
             int threads)
      : kind_(kind_named(model)), model_(make_model(kind_)), world_(make_world(*settled, fixed_debris, threads)) {
    world_.add_robot(model_, to_pose(pose, "pose"));
  }

  void drive(double linear, double angular, const std::vector<double>& flippers) {
    expect(model_.sides.any(), "drive", "this robot has neither tracks nor wheels", "crawler or rover");
    expect(std::isfinite(linear) && std::isfinite(angular), "drive", "not a finite number", "m/s and rad/s");
    const std::size_t wanted = kind_ == Kind::crawler ? kFlippers : 0;
    expect(flippers.empty() || flippers.size() == wanted, "flippers", "wrong number of angles",
           wanted ? std::to_string(wanted) + " or none" : "none");
    for (const double angle : flippers) expect(std::isfinite(angle), "flippers", "not a finite number", "radians");
    const Twist twist{linear, angular};
    command_ = kind_ == Kind::rover ? drive_wheels(model_, twist) : drive_tracks(model_, twist, flippers);
  }

  // Of a vine: the speed of its tip (negative: it retracts) and the curvature of what grows; unit: m/s, 1/m
  void grow(double speed, double left, double up) {
    expect(kind_ == Kind::vine, "grow", "this robot does not grow", "vine");
    expect(std::isfinite(speed) && std::isfinite(left) && std::isfinite(up), "grow", "out of range",
           "a finite speed and finite curvatures");
    command_ = drive_vine(model_, {speed, left, up});
  }

  // Targets of the joints; unit: rad.
  void set_joints(const std::vector<double>& targets) {
    expect(targets.size() == model_.joints.size(), "targets", "wrong number of angles",
           std::to_string(model_.joints.size()));
    command_.joints.clear();
    for (const double target : targets) {
      expect(std::isfinite(target), "targets", "not a finite number", "radians");
      command_.joints.push_back({MotorMode::position, target});
    }
  }

  void step(double seconds) {
    expect(seconds > 0 && seconds <= 60, "seconds", "out of range", "more than 0, at most 60");
    const int steps = std::max(1, int(seconds / kStep + 0.5));
    {
      const py::gil_scoped_release free;
      for (int i = 0; i < steps; ++i) {
        if (!world_.robot_state(0).lost) world_.set_command(0, command_);
        world_.step();
        if (world_.steps() == first_ + 1) deepest_ = find_deepest();
      }
    }
    if (deepest_ < -kMostDepth)
      throw InputError({"", 0, "pose", "the robot stands " + std::to_string(-deepest_) + " m deep in something",
                        "a place that is free", "", "Pile.clearance() tells how far surfaces are"});
  }

  py::dict state() const {
    const RobotState s = world_.robot_state(0);
    py::dict out;
    py::array_t<double> links = make_array<double>({py::ssize_t(s.links.size()), 7});
    for (std::size_t i = 0; i < s.links.size(); ++i) put_pose(s.links[i].world_from_link, links.mutable_data() + 7 * i);
    std::vector<double> angles, speeds, torques, forces;
    for (const RobotState::Joint& j : s.joints)
      angles.push_back(j.position), speeds.push_back(j.speed), torques.push_back(j.torque);
    for (const RobotState::Link& link : s.links)
      for (int k = 0; k < 3; ++k) forces.push_back(link.contact_force[k]);
    const auto joints = py::ssize_t(s.joints.size());
    out["time"] = world_.time();
    out["links"] = links;
    out["joint_positions"] = take_vector(std::move(angles), {joints});
    out["joint_speeds"] = take_vector(std::move(speeds), {joints});
    out["joint_torques"] = take_vector(std::move(torques), {joints});
    out["contact_forces"] = take_vector(std::move(forces), {py::ssize_t(s.links.size()), 3});
    out["linear_velocity"] = from_vector(s.links[0].linear), out["angular_velocity"] = from_vector(s.links[0].angular);
    if (kind_ == Kind::vine) out["length"] = s.length, out["tip_force"] = s.tip_force;
    out["lost"] = s.lost;
    return out;
  }

  int joints() const { return int(model_.joints.size()); }
  std::vector<std::string> link_names() const {
    std::vector<std::string> names;
    for (const RobotLink& link : model_.links) names.push_back(link.name);
    return names;
  }

 private:
  World make_world(const SettledMission& settled, bool fixed, int threads) {
    const Pile pile = make_laid_pile(settled.mission, settled.state);
    World world(pile.types, world_options(settled.mission.scenario, threads), pile.assemblies);
    world.lay(pile, settled.state, fixed);
    world.set_step(kStep, kSubsteps);
    first_ = world.steps();
    return world;
  }

  static void expect(bool fine, const char* key, const char* message, const std::string& expected) {
    if (!fine) throw InputError({"", 0, key, message, expected, "", ""});
  }

  double find_deepest() const {
    const int first = world_.robot_piece(0), last = first + int(model_.links.size());
    double deepest = 0;
    for (const RobotContact& c : world_.robot_contacts(0))
      if (c.piece < first || c.piece >= last) deepest = std::min(deepest, c.separation);
    return deepest;
  }

  Kind kind_;
  RobotModel model_;
  std::int64_t first_ = 0;  // steps before the robot's first
  World world_;
  RobotCommand command_;
  double deepest_ = 0;  // overlap after the first step; unit: m
};

}  // namespace

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
