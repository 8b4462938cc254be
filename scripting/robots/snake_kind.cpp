// The snake in missions: gaits as commands.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernel/base/portable_math.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/robots/snake.h"

namespace rubble {
namespace {

struct SnakeFigures : FiguresOf<SnakeFigures> {
  int modules = 16;

  void add_keys(Schema& k) override { k.value("modules", modules, "Snake: number of modules.").between(2, 64); }
  bool operator==(const SnakeFigures& other) const { return modules == other.modules; }
};

enum class GaitKind { lateral_undulation, sidewinding, rolling, serpenoid, helical_rolling };

struct SnakeCommand : FiguresOf<SnakeCommand> {
  GaitKind gait = GaitKind::sidewinding;
  double rate = 4, phase = 0;  // of its waves: sin(... - rate t - phase)
  double amplitude = 1, steering_deg = 0;

  void add_keys(Schema& k) override {
    k.choice("gait", gait, {"lateral_undulation", "sidewinding", "rolling", "serpenoid", "helical_rolling"}, "Snake: the gait.");
    k.value("rate", rate, "Snake: angular frequency of the waves; negative: backwards.").between(-20, 20).unit("rad/s");
    k.value("phase", phase, "Snake: phase of the waves in addition to rate * t; for a smooth change of `rate`.")
        .between(-1e6, 1e6)
        .unit("rad");
    k.value("amplitude", amplitude, "Snake: amplitude, relative to that of the gait.").between(0, 2);
    k.value("steering_deg", steering_deg, "Snake: offset of the sideways joints.").between(-45, 45).unit("degree");
  }
  bool operator==(const SnakeCommand& other) const {
    const auto all = [](const SnakeCommand& c) { return std::tie(c.gait, c.rate, c.phase, c.amplitude, c.steering_deg); };
    return all(*this) == all(other);
  }

  SnakeGait waves() const {
    static SnakeGait (*const kGaits[])() = {lateral_undulation, sidewinding, rolling, [] { return serpenoid(0); }, helical_rolling};
    SnakeGait waves = kGaits[int(gait)]();
    waves.rate = rate;
    waves.lateral_phase -= phase, waves.vertical_phase -= phase;
    waves.lateral_amplitude *= amplitude;
    waves.vertical_amplitude *= amplitude;
    waves.steering = steering_deg * (portable::kPi / 180);
    return waves;
  }
};

constexpr double kGaitRate = 4;  // of the waves at a full axis; unit: rad/s
constexpr double kSteering = 20;  // at a full axis; unit: degree

class Snake : public RobotKind {
 public:
  std::string name() const override { return "snake"; }
  std::unique_ptr<RobotFigures> figures() const override { return std::make_unique<SnakeFigures>(); }
  std::unique_ptr<RobotFigures> command_figures() const override { return std::make_unique<SnakeCommand>(); }

  RobotModel make(const RobotItem& robot) const override {
    SnakeOptions options;
    options.modules = robot.figures.of<SnakeFigures>().modules;
    options.friction = robot.friction.value_or(options.friction);
    return make_snake(options);
  }

  // It lies straight.
  RobotLeg still(const RobotItem& robot) const override {
    RobotLeg leg;
    SnakeCommand& own = leg.figures.of<SnakeCommand>();
    if (!robot.drive.empty()) own.gait = robot.drive.front().figures.of<SnakeCommand>().gait;
    own.rate = own.amplitude = 0;
    return leg;
  }
  RobotCommand command(const RobotModel& model, const RobotLeg& leg, double time) const override {
    return calc_gait(model, leg.figures.of<SnakeCommand>().waves(), time);
  }

  void steer(const TeleopCommand& asked, const RobotItem& robot, const RobotLeg& last, double seconds, RobotLeg& leg) const override {
    RobotKind::steer(asked, robot, last, seconds, leg);
    leg.linear = leg.angular = 0;  // it has neither tracks nor wheels
    SnakeCommand& own = leg.figures.of<SnakeCommand>();
    const SnakeCommand& was = last.figures.of<SnakeCommand>();
    const double forwards = within(asked.forward + (asked.speed > 0 ? asked.linear.x / asked.speed : 0), 1);
    own.rate = std::abs(forwards) > 0.01 ? kGaitRate * forwards : 0;
    own.phase = was.phase + (was.rate - own.rate) * leg.t;  // the waves go on from where they are
    own.amplitude = 1;
    // It steers by an angle: a rate of turn counts as a share of a full axis.
    own.steering_deg = kSteering * within(asked.yaw + asked.angular.z / kTurn, 1);
  }
};

}  // namespace

std::unique_ptr<RobotKind> make_snake_kind() { return std::make_unique<Snake>(); }

}  // namespace rubble
