// The robots of a mission stepped from Python, and what their sensors measure meanwhile.
#include "app/provenance/provenance.h"
#include "app/session/session.h"


#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "app/control/robot_control.h"
#include "kernel/world/world_robots.h"
#include "python/one_thread.h"
#include "python/parts.h"
#include "python/robot_commands.h"
#include "scripting/robots/robot_kind.h"

namespace rubble::python {
namespace {

constexpr double kMostControlHz = 240;  // a command each step

Array<double> to_array(std::vector<double> values) {
  const auto count = Size(values.size());
  return take_vector(std::move(values), {count});
}

class MissionSession : public OneThread {
  template <typename Work>
  auto with_lines(const Work& work) const {
    return with_lines_of_script(settled_->mission, work);
  }

 public:
  // The robots of the mission.
  MissionSession(SharedPile settled, bool observed, bool depth, int threads)
      : settled_(std::move(settled)), context_(quiet(threads)), session_(with_lines([&] { return make(observed, depth); })) {
    with_lines([&] {
      const nb::gil_scoped_release free;
      session_->start();
      return true;
    });
  }

  // One bundled robot instead of them, whose motors are off until the first command. Its first link is at `base`.
  // friction: instead of the model's.
  MissionSession(SharedPile settled, const std::string& kind, const Pose& base, bool fixed_debris, int threads,
                 std::optional<double> friction)
      : settled_(std::move(settled)), alone_(settled_->mission), context_(quiet(threads)) {
    const Scenario& whole = settled_->mission.scenario;
    Scenario& bare = alone_->scenario;
    bare = Scenario();
    adopt_pile(bare, whole);
    bare.seed = whole.seed, bare.start_ns = whole.start_ns, bare.surroundings = whole.surroundings;
    bare.robots = {make_robot_item(kind)};
    if (friction && !(*friction >= 0 && *friction <= 2))
      throw InputError({"", 0, "friction", "out of range", "0 to 2", std::to_string(*friction), ""});
    bare.robots[0].friction = friction;
    bare.robot_run.control_hz = kMostControlHz;  // commands count from the next step on
    if (fixed_debris) bare.robot_run.debris = DebrisMotion::fixed;
    MissionRobot robot;
    robot.model = kind_of(bare.robots[0]).make(bare.robots[0]), robot.placed_from_base = base;
    SessionOptions options;
    options.restarts = true;
    session_ = std::make_unique<Session>(*alone_, settled_->state, std::vector<MissionRobot>{std::move(robot)}, context_,
                                         options);
    session_->set_controller(0, [](const RobotSense&) { return RobotCommand(); });
    session_->start();
  }

  // Back to time 0, with the bits of a new session. poses: of first links, by robot; others stand where the mission, or
  // the constructor, puts them.
  void reset(const std::map<std::string, DoubleArray>& poses) {
    for (std::size_t i = 0; i < robots().size(); ++i) session_->place(i, std::nullopt);
    for (const auto& [robot, pose] : poses) session_->place(find(robot), to_pose(pose, "pose"));
    last_.clear(), refused_.reset();
    const auto start = [&] {
      const nb::gil_scoped_release free;
      session_->start();
      return true;
    };
    alone_ ? start() : with_lines(start);
  }

  void drive(const std::string& robot, double linear, double angular, const std::vector<double>& flippers) {
    command(robot, [&](const RobotModel& model) { return make_twist_command(model, linear, angular, flippers); });
  }
  void grow(const std::string& robot, double speed, double left, double up) {
    command(robot, [&](const RobotModel& model) { return make_growth_command(model, speed, left, up); });
  }
  void set_joints(const std::string& robot, const std::vector<double>& targets) {
    command(robot, [&](const RobotModel& model) { return make_joints_command(model, targets); }, true);
  }
  void follow_mission(const std::string& robot) {
    last_.erase(find(robot));
    session_->command(find(robot), std::nullopt);
  }

  void step(double seconds) {
    const int steps = count_steps(seconds, session_->step_time());
    if (refused_) throw *refused_;
    const auto go = [&] {
      const nb::gil_scoped_release free;
      for (int i = 0; i < steps; ++i) session_->step();
      return true;
    };
    if (!alone_) return void(with_lines(go));
    try {
      go();
    } catch (const InputError& error) {
      Diagnostic d = error.diagnostics().front();
      d.key = "pose";
      refused_.emplace(d);
      throw *refused_;
    }
  }

  nb::list observe() {
    std::vector<Sample> samples;
    {
      const nb::gil_scoped_release free;
      samples = session_->observe();
    }
    nb::list out;
    for (Sample& sample : samples) {
      nb::dict one = std::visit([this](auto& of) { return describe(of); }, sample);
      one["stamp"] = stamp_of(sample);
      out.append(one);
    }
    return out;
  }

  nb::dict state(const std::string& robot) const {
    const std::size_t i = find(robot);
    return describe_state(session_->robots()[i].model, session_->world().robots().state(int(i)), time());
  }

  double time() const { return session_->world().time(); }
  const std::vector<std::string>& robots() const { return session_->names(); }
  std::vector<std::string> link_names(const std::string& robot) const {
    return link_names_of(session_->robots()[find(robot)].model);
  }

 private:
  std::unique_ptr<Session> make(bool observed, bool depth) {
    if (scenario().robots.empty())
      throw InputError({"", 0, "robots", "the mission has no robots", "a mission with `robots`", "none", ""});
    SessionOptions options;
    options.observed = observed, options.depth = depth, options.restarts = true;
    return std::make_unique<Session>(settled_->mission, settled_->state, make_robots(settled_->mission, context_), context_,
                                     options);
  }
  const Scenario& scenario() const { return alone_ ? alone_->scenario : settled_->mission.scenario; }

  std::size_t find(const std::string& robot) const {
    const std::vector<std::string>& names = session_->names();
    const auto at = std::find(names.begin(), names.end(), robot);
    if (at != names.end()) return std::size_t(at - names.begin());
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "one of " : ", ") + name;
    throw InputError({"", 0, "robot", "no robot has this name", all, "\"" + robot + "\"", ""});
  }
  // belts_go_on: those of its last command.
  template <typename Make>
  void command(const std::string& robot, const Make& make_command, bool belts_go_on = false) {
    const std::size_t i = find(robot);
    RobotCommand asked = make_command(session_->robots()[i].model);
    if (const auto last = last_.find(i); belts_go_on && last != last_.end())
      asked.belts = last->second.belts, asked.curve_left = last->second.curve_left, asked.curve_up = last->second.curve_up;
    session_->command(i, last_[i] = std::move(asked));
  }

  static nb::dict named(const char* kind, const std::string& sensor) {
    nb::dict out;
    out["kind"] = kind, out["sensor"] = sensor;
    return out;
  }
  nb::dict describe(const RobotSample& s) const {
    nb::dict out = named("robot", session_->names()[std::size_t(s.sensor)]);
    std::vector<double> wrenches;
    for (const RobotSample::Wrench& w : s.contacts)
      for (const Vec3* v : {&w.force, &w.moment}) wrenches.insert(wrenches.end(), {v->x, v->y, v->z});
    out["positions"] = to_array(s.positions), out["speeds"] = to_array(s.speeds), out["efforts"] = to_array(s.efforts);
    out["contacts"] = take_vector(std::move(wrenches), {Size(s.contacts.size()), 6});
    out["pose"] = from_pose(s.world_from_base);
    out["linear_velocity"] = from_vector(s.linear_velocity), out["angular_velocity"] = from_vector(s.angular_velocity);
    if (s.odometry) out["odometry"] = from_pose(s.odometry->odom_from_base);
    return out;
  }
  nb::dict describe(const ImuSample& s) const {
    nb::dict out = named("imu", scenario().imus[std::size_t(s.sensor)].name);
    out["angular_velocity"] = from_vector(s.angular_velocity);
    out["linear_acceleration"] = from_vector(s.linear_acceleration);
    return out;
  }
  nb::dict describe(const Reading& s) const {
    const SensorItem& sensor = scenario().sensors[std::size_t(s.sensor)];
    nb::dict out = named(sensor.figures->sample_name().c_str(), sensor.name);
    if (s.scan) {
      out["points"] = to_structured(std::vector<ScanPoint>(s.scan->points));
      out["pose"] = from_pose(s.scan->world_from_sensor.front());
    }
    const std::vector<ReadingColumn> columns = sensor.figures->columns();
    for (std::size_t i = 0; i < columns.size(); ++i) out[columns[i].name.c_str()] = s.values[i];
    return out;
  }
  nb::dict describe(Frame& s) const {
    nb::dict out = named("camera", scenario().cameras[std::size_t(s.sensor)].name);
    const Intrinsics& k = s.intrinsics;
    out["K"] = camera_matrix(k), out["pose"] = from_pose(s.world_from_camera);
    if (!s.depth.empty()) out["depth"] = take_vector(std::move(s.depth), {k.height, k.width});
    if (!s.rgb.empty()) out["rgb"] = take_vector(std::move(s.rgb), {k.height, k.width, 3});
    return out;
  }

  SharedPile settled_;
  std::optional<ResolvedMission> alone_;  // of a robot that the mission does not have
  RunContext context_;
  std::unique_ptr<Session> session_;
  std::map<std::size_t, RobotCommand> last_;  // by robot
  std::optional<InputError> refused_;         // that robot has no room
};

}  // namespace

void add_sessions(nb::module_& module) {
  nb::class_<MissionSession>(module, "_Session")
      .def("__init__", [](MissionSession* made, const SharedPile& settled, bool observed, bool depth,
                          const nb::object& threads) {
        new (made) MissionSession(settled, observed, depth, to_threads(threads));
      })
      .def("__init__", [](MissionSession* made, const SharedPile& settled, const std::string& robot, const DoubleArray& pose,
                          bool fixed_debris, const nb::object& threads, std::optional<double> friction) {
        new (made) MissionSession(settled, robot, to_pose(pose, "pose"), fixed_debris, to_threads(threads), friction);
      })
      .def("reset", in_one_thread(&MissionSession::reset))
      .def("drive", in_one_thread(&MissionSession::drive))
      .def("grow", in_one_thread(&MissionSession::grow))
      .def("set_joints", in_one_thread(&MissionSession::set_joints))
      .def("follow_mission", in_one_thread(&MissionSession::follow_mission))
      .def("step", in_one_thread(&MissionSession::step))
      .def("observe", in_one_thread(&MissionSession::observe))
      .def("state", in_one_thread(&MissionSession::state))
      .def("link_names", in_one_thread(&MissionSession::link_names))
      .def_prop_ro("robots", in_one_thread(&MissionSession::robots))
      .def_prop_ro("time", in_one_thread(&MissionSession::time));
}

}  // namespace rubble::python
