// The vine robot in missions: growth and curvature as commands.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernel/base/number_text.h"
#include "kernel/robot/drive_commands.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/robots/vine.h"

namespace rubble {
namespace {

struct VineFigures : FiguresOf<VineFigures> {
  double pressure = 10e3, radius = 0.05, length = 3, link_length = 0.05;

  void add_keys(Schema& k) override {
    k.value("pressure", pressure, "Vine: gauge pressure in the tube.").above(0, 1e6).unit("Pa");
    k.value("radius", radius, "Vine: radius of the tube.").between(0.01, 0.3).unit("m");
    k.value("length", length, "Vine: largest length, at least one link.").above(0, 100).unit("m");
    k.value("link_length", link_length, "Vine: length of the rigid links that model the tube.").between(0.02, 0.5).unit("m");
  }
  bool operator==(const VineFigures& other) const {
    const auto all = [](const VineFigures& f) { return std::tie(f.pressure, f.radius, f.length, f.link_length); };
    return all(*this) == all(other);
  }
};

struct VineCommand : FiguresOf<VineCommand> {
  double growth = 0, curvature = 0, curvature_up = 0;

  void add_keys(Schema& k) override {
    k.value("growth", growth, "Vine: speed of the tip; negative: retracts.").between(-1, 1).unit("m/s");
    k.value("curvature", curvature, "Vine: curvature of new links, to the left.").between(-5, 5).unit("1/m");
    k.value("curvature_up", curvature_up, "Vine: curvature of new links, upwards.").between(-5, 5).unit("1/m");
  }
  bool operator==(const VineCommand& other) const {
    const auto all = [](const VineCommand& c) { return std::tie(c.growth, c.curvature, c.curvature_up); };
    return all(*this) == all(other);
  }
};

constexpr double kCurvature = 1.5;  // of a full axis; unit: 1/m

Value list_of(const Vec3& v) {
  Value list = Value::make_table();
  for (int i = 0; i < 3; ++i) list.items.push_back(Value::make_number(v[i]));
  return list;
}

class Vine : public RobotKind {
 public:
  std::string name() const override { return "vine"; }
  std::unique_ptr<RobotFigures> figures() const override { return std::make_unique<VineFigures>(); }
  std::unique_ptr<RobotFigures> command_figures() const override { return std::make_unique<VineCommand>(); }

  void check(const RobotItem& robot, const std::string& key, std::vector<Diagnostic>& mistakes) const override {
    const VineFigures& own = robot.figures.of<VineFigures>();
    const double links = std::floor(own.length / own.link_length + 1e-9);
    if (links < 1)
      mistakes.push_back({"", 0, key + "length", "shorter than a link",
                          "link_length (" + exact_text(own.link_length) + " m) or more", exact_text(own.length) + " m",
                          "a shorter link_length makes more of a short vine"});
    if (links > kMostTubeLinks)
      mistakes.push_back({"", 0, key + "length", "too many links",
                          std::to_string(kMostTubeLinks) + " links of link_length or fewer", exact_text(links),
                          "a longer link_length needs fewer"});
  }

  RobotModel make(const RobotItem& robot) const override {
    const VineFigures& own = robot.figures.of<VineFigures>();
    VineOptions options;
    options.tube.pressure = own.pressure;
    options.tube.radius = own.radius;
    options.tube.link_length = own.link_length;
    options.tube.links = count_vine_links(own.length, own.link_length);
    options.tube.start_links = std::min(options.tube.start_links, options.tube.links);
    options.friction = robot.friction.value_or(options.friction);
    return make_vine(options);
  }

  RobotCommand command(const RobotModel& model, const RobotLeg& leg, double) const override {
    const VineCommand& own = leg.figures.of<VineCommand>();
    return grow_tube(model, own.growth, own.curvature, own.curvature_up);
  }
  void add_answer_keys(RobotLeg& leg, Schema& keys) const override { leg.figures.of<VineCommand>().add_keys(keys); }
  RobotCommand answer(const RobotModel& model, const RobotLeg& leg) const override { return command(model, leg, 0); }

  // It bends by a curvature: rates of turn count as shares of a full axis.
  void steer(const TeleopCommand& asked, const RobotItem& robot, const RobotLeg& last, double seconds, RobotLeg& leg) const override {
    RobotKind::steer(asked, robot, last, seconds, leg);
    VineCommand& own = leg.figures.of<VineCommand>();
    own.growth = within(leg.linear, 1);
    leg.linear = leg.angular = 0;  // it has neither tracks nor wheels
    own.curvature = kCurvature * within(asked.yaw + asked.angular.z / kTurn, 1);
    own.curvature_up = kCurvature * within(-asked.pitch - asked.angular.y / kTurn, 1);
  }

  void tell(const RobotState& state, Value& told, Value& truth) const override {
    const RobotState::Link& tip = state.links.back();
    const Quat& rotation = tip.world_from_link.rotation;
    Value vine = Value::make_table(), place = Value::make_table();
    vine.set("length", Value::make_number(state.length));
    vine.set("speed", Value::make_number(state.joints.back().speed));
    vine.set("force", Value::make_number(-dot(tip.contact_force, rotation.rotate({1, 0, 0}))));
    vine.set("most_force", Value::make_number(state.tip_force));
    place.set("position", list_of(tip.world_from_link.translation));
    place.set("forwards", list_of(rotation.rotate({1, 0, 0})));
    place.set("left", list_of(rotation.rotate({0, 1, 0})));
    place.set("up", list_of(rotation.rotate({0, 0, 1})));
    told.set("vine", std::move(vine));
    truth.set("tip", std::move(place));
  }
};

}  // namespace

std::unique_ptr<RobotKind> make_vine_kind() { return std::make_unique<Vine>(); }

}  // namespace rubble
