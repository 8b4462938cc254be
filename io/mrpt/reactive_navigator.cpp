#include "io/mrpt/reactive_navigator.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/holonomic/CHolonomicFullEval.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem3D.h>
#include <mrpt/nav/reactive/CRobot2NavInterface.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

using mrpt::kinematics::CVehicleVelCmd;
using mrpt::kinematics::CVehicleVelCmd_DiffDriven;
using mrpt::nav::CAbstractNavigator;

constexpr double kEpoch = 1e9;  // of simulated time, on MRPT's clock; unit: s
constexpr int kPaths = 61;      // of a family
constexpr double kDegrees = 180 / portable::kPi;
constexpr double kEdge = 0.05;  // around the robot's shape; unit: m
constexpr double kCell = 0.05;  // of the tables of arcs; unit: m
// Arcs that are free for less are not driven; those that are free for less than kSlowDown are driven slower; unit: m.
constexpr double kTooClose = 0.06, kSlowDown = 0.4;

// MRPT's clock is the simulation's while one of these lives.
class SimulatedClock {
 public:
  SimulatedClock() : before_(mrpt::Clock::getActiveClock()) {
    set(0);
    mrpt::Clock::setActiveClock(mrpt::Clock::Simulated);
  }
  ~SimulatedClock() { mrpt::Clock::setActiveClock(before_); }
  SimulatedClock(const SimulatedClock&) = delete;
  SimulatedClock& operator=(const SimulatedClock&) = delete;

  static void set(double time) { mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(kEpoch + time)); }

 private:
  mrpt::Clock::Source before_;
};

// What the navigator asks of a robot: answers of the last input; its commands are kept for the output.
class SteppedRobot : public mrpt::nav::CRobot2NavInterface {
 public:
  SteppedRobot() {
    setMinLoggingLevel(mrpt::system::LVL_ERROR);
    logging_enable_console_output = false;
  }

  bool getCurrentPoseAndSpeeds(mrpt::math::TPose2D& pose, mrpt::math::TTwist2D& velocity,
                               mrpt::system::TTimeStamp& stamp, mrpt::math::TPose2D& odometry,
                               std::string& frame) override {
    pose = odometry = {input.x, input.y, input.yaw};
    velocity = {input.velocity_x, input.velocity_y, input.turn_rate};
    stamp = mrpt::Clock::now();
    frame = "map";
    return true;
  }
  bool changeSpeeds(const CVehicleVelCmd& command) override {
    const auto& twist = dynamic_cast<const CVehicleVelCmd_DiffDriven&>(command);
    output.linear = twist.lin_vel, output.angular = twist.ang_vel;
    return true;
  }
  bool changeSpeedsNOP() override { return true; }
  bool stop(bool) override {
    output.linear = output.angular = 0;
    return true;
  }
  CVehicleVelCmd::Ptr getStopCmd() override { return std::make_shared<CVehicleVelCmd_DiffDriven>(); }
  CVehicleVelCmd::Ptr getEmergencyStopCmd() override { return getStopCmd(); }
  bool startWatchdog(float) override { return true; }
  bool stopWatchdog() override { return true; }
  bool senseObstacles(mrpt::maps::CSimplePointsMap& obstacles, mrpt::system::TTimeStamp& stamp) override {
    obstacles.clear();
    for (Vec3f p : input.obstacles) {
      push_out(p);
      obstacles.insertPointFast(p.x, p.y, p.z);
    }
    obstacles.mark_as_modified();
    stamp = mrpt::Clock::now();
    return true;
  }
  double getNavigationTime() override { return input.time; }
  void resetNavigationTimer() override {}

  NavigatorInput input;
  NavigatorOutput output;
  std::vector<NavigatorSlice> slices;

 private:
  // With an obstacle in the robot's shape, where noise and slip may put it, MRPT finds every way blocked, also those
  // that lead away. Such a point is taken to the nearest edge, so that it blocks the ways to it.
  void push_out(Vec3f& p) const {
    double below = 0;
    for (const NavigatorSlice& s : slices) {
      below += s.height;
      if (p.z >= below) continue;
      const double in_x = s.half_length + kEdge - std::fabs(p.x), in_y = s.half_width + kEdge - std::fabs(p.y);
      if (in_x <= 0 || in_y <= 0) return;
      float& moved = in_x < in_y ? p.x : p.y;
      moved += float(std::copysign(std::min(in_x, in_y), moved));
      return;
    }
  }
};

// Prints nothing when it ends.
class QuietNavigator : public mrpt::nav::CReactiveNavigationSystem3D {
 public:
  explicit QuietNavigator(SteppedRobot& robot) : CReactiveNavigationSystem3D(robot, false) {
    setMinLoggingLevel(mrpt::system::LVL_ERROR);
    logging_enable_console_output = false;
    enableTimeLog(false);
    m_timlog_delays.enable(false);
  }
};

void expect_positive(const char* key, double value) {
  if (!(value > 0)) throw InputError({"", 0, key, "out of range", "more than 0", plain_text(value), ""});
}

void check(const NavigatorOptions& o) {
  if (o.slices.empty()) throw InputError({"", 0, "slices", "no robot", "one prism or more", "none", ""});
  for (const NavigatorSlice& slice : o.slices) {
    expect_positive("slices.height", slice.height);
    expect_positive("slices.half_length", slice.half_length);
    expect_positive("slices.half_width", slice.half_width);
  }
  expect_positive("max_speed", o.max_speed);
  expect_positive("max_turn_rate", o.max_turn_rate);
  expect_positive("horizon", o.horizon);
  expect_positive("goal_radius", o.goal_radius);
  expect_positive("give_up_after", o.give_up_after);
}

// One of MRPT's families of paths. direction: 1: forwards, -1: backwards.
struct Family {
  const char* type;
  int direction;
  double priority;
};
// Arcs; ways that turn towards a heading and go on straight; arcs backwards.
constexpr Family kFamilies[]{
    {"CPTG_DiffDrive_C", 1, 1}, {"CPTG_DiffDrive_alpha", 1, 0.95}, {"CPTG_DiffDrive_C", -1, 0.5}};

void add_families(mrpt::config::CConfigFileMemory& config, const NavigatorOptions& o) {
  const std::string section = "CReactiveNavigationSystem3D";
  int number = 0;
  for (const Family& family : kFamilies) {
    const std::string prefix = "PTG" + std::to_string(++number) + "_";
    config.write(section, prefix + "Type", std::string(family.type));
    config.write(section, prefix + "resolution", kCell);
    config.write(section, prefix + "refDistance", o.horizon);
    config.write(section, prefix + "num_paths", kPaths);
    config.write(section, prefix + "v_max_mps", o.max_speed);
    config.write(section, prefix + "w_max_dps", o.max_turn_rate * kDegrees);
    config.write(section, prefix + "K", double(family.direction));
    config.write(section, prefix + "cte_a0v_deg", 57.0);
    config.write(section, prefix + "cte_a0w_deg", 57.0);
    config.write(section, prefix + "score_priority", family.priority);
  }
  config.write(section, "PTG_COUNT", number);
}

void add_shape(mrpt::config::CConfigFileMemory& config, const NavigatorOptions& o) {
  const std::string section = "CReactiveNavigationSystem3D";
  config.write(section, "HEIGHT_LEVELS", int(o.slices.size()));
  for (std::size_t i = 0; i < o.slices.size(); ++i) {
    const NavigatorSlice& s = o.slices[i];
    const std::string level = "LEVEL" + std::to_string(i + 1) + "_";
    char x[100], y[100];
    std::snprintf(x, sizeof x, "%.4f %.4f %.4f %.4f", s.half_length, s.half_length, -s.half_length, -s.half_length);
    std::snprintf(y, sizeof y, "%.4f %.4f %.4f %.4f", -s.half_width, s.half_width, s.half_width, -s.half_width);
    config.write(section, level + "HEIGHT", s.height);
    config.write(section, level + "VECTORX", std::string(x));
    config.write(section, level + "VECTORY", std::string(y));
  }
}

// How an arc is judged: how near it comes to the goal, how far it is free, and whether it is the arc of before.
void add_scores(mrpt::config::CConfigFileMemory& config) {
  const std::string scores = "CMultiObjectiveMotionOptimizerBase";
  config.write(scores, "score1_name", "nearness");
  config.write(scores, "score1_formula", "1/(1+dist_eucl_min^2)");
  config.write(scores, "score2_name", "freedom");
  config.write(scores, "score2_formula", "min(1, collision_free_distance/min(1, max(0.05, target_d_norm)))");
  config.write(scores, "score3_name", "steadiness");
  config.write(scores, "score3_formula", "hysteresis");
  config.write(scores, "score4_name", "priority");
  config.write(scores, "score4_formula", "ptg_priority");
  config.write("CMultiObjMotionOpt_Scalarization", "scalar_score_formula",
               "priority*(4*nearness + freedom + 0.2*steadiness)");
}

// Directions are judged by how far they are free, how near their sector is to the goal's, how near the goal they end,
// and whether they are those of before. MRPT wants a number for each of its factors, of which 2.5 has seven and 2.14
// eight, which no header tells: the list grows until it is taken.
void add_evaluation(mrpt::config::CConfigFileMemory& config, const std::string& section, const NavigatorOptions& o) {
  config.write(section, "TOO_CLOSE_OBSTACLE", kTooClose / o.horizon);
  config.write(section, "OBSTACLE_SLOW_DOWN_DISTANCE", kSlowDown / o.horizon);
  config.write(section, "TARGET_SLOW_APPROACHING_DISTANCE", kSlowDown);
  config.write(section, "PHASE_COUNT", 1);
  config.write(section, "PHASE1_FACTORS", "[0 1 2 3]");
  config.write(section, "PHASE1_THRESHOLD", 0.9);
  constexpr int kLeastFactors = 7, kMostFactors = 12;
  std::string weights = "[0.5, 0.3, 1, 0.1, 0, 0, 0", as_they_are = "[0, 0, 0, 0, 0, 0, 0";
  for (int factors = kLeastFactors;; ++factors) {
    config.write(section, "factorWeights", weights + "]");
    config.write(section, "factorNormalizeOrNot", as_they_are + "]");
    try {
      mrpt::nav::CHolonomicFullEval::TOptions().loadFromConfigFile(config, section);
      return;
    } catch (const std::exception&) {
      if (factors == kMostFactors) throw;
    }
    weights += ", 0", as_they_are += ", 0";
  }
}

mrpt::config::CConfigFileMemory make_config(const NavigatorOptions& o) {
  mrpt::config::CConfigFileMemory config;
  const std::string base = "CAbstractPTGBasedReactive", evaluation = "CHolonomicFullEval";
  config.write("CAbstractNavigator", "alarm_seems_not_approaching_target_timeout", o.give_up_after);
  config.write(base, "robotMax_V_mps", o.max_speed);
  config.write(base, "robotMax_W_degps", o.max_turn_rate * kDegrees);
  config.write(base, "holonomic_method", evaluation);
  config.write(base, "motion_decider_method", "CMultiObjMotionOpt_Scalarization");
  config.write(base, "ref_distance", o.horizon);
  config.write(base, "use_delays_model", false);  // there are none in lock-step
  config.write(base, "enable_obstacle_filtering", false);
  config.write(base, "evaluate_clearance", false);
  add_evaluation(config, evaluation, o);
  config.write(base, "secure_distance_start", 0.0);
  config.write(base, "secure_distance_end", kSlowDown / o.horizon);
  config.write(base, "max_distance_predicted_actual_path", 0.15);
  add_scores(config);
  add_shape(config, o);
  add_families(config, o);
  return config;
}

// Of MRPT into ours.
template <typename Call>
void guarded(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    throw RunError(std::string("MRPT's navigator failed: ") + error.what());
  }
}

}  // namespace

struct ReactiveNavigator::Impl {
  SimulatedClock clock;
  SteppedRobot robot;
  QuietNavigator navigator{robot};
  double goal_radius = 0;
};

ReactiveNavigator::ReactiveNavigator(const NavigatorOptions& options) {
  check(options);
  impl_ = std::make_unique<Impl>();
  impl_->goal_radius = options.goal_radius;
  impl_->robot.slices = options.slices;
  guarded([&] {
    auto& navigator = impl_->navigator;
    navigator.enableRethrowNavExceptions(true);
    navigator.params_abstract_ptg_navigator.ptg_cache_files_directory = options.cache_folder;
    navigator.loadConfigFile(make_config(options));
    navigator.initialize();
  });
}

ReactiveNavigator::~ReactiveNavigator() = default;

void ReactiveNavigator::set_goal(double x, double y) {
  guarded([&] {
    impl_->navigator.resetNavError();
    CAbstractNavigator::TNavigationParams goal;
    goal.target.target_coords = {x, y, 0};
    goal.target.targetAllowedDistance = float(impl_->goal_radius);
    impl_->navigator.navigate(&goal);
  });
}

NavigatorOutput ReactiveNavigator::step(const NavigatorInput& input) {
  SimulatedClock::set(input.time);
  impl_->robot.input = input;
  NavigatorOutput& output = impl_->robot.output;
  guarded([&] { impl_->navigator.navigationStep(); });
  switch (impl_->navigator.getCurrentState()) {
    case CAbstractNavigator::IDLE:
      output = {NavigatorState::arrived, 0, 0};
      break;
    case CAbstractNavigator::NAV_ERROR:
      output = {NavigatorState::gave_up, 0, 0};
      break;
    default:
      output.state = NavigatorState::driving;
  }
  return output;
}

}  // namespace rubble
