// What drives a robot by its sides: tracks, wheels, and joints that steer these.
#include <algorithm>
#include <cmath>

#include "app/robots/urdf_draft.h"

namespace rubble {
namespace {

constexpr double kLeftwards = 0.999;  // cosine between a wheel's axis and +Y
constexpr double kUpwards = 0.9;      // between that of steering and Z, less its caster angle

class Drive {
 public:
  explicit Drive(UrdfDraft& draft)
      : draft_(draft), zero_(calc_base_from_links(draft.made.model, std::vector<double>(draft.made.model.joints.size(), 0))) {}

  void add_tracks() {
    SideDrive& sides = draft_.made.model.sides;
    sides.left = tracks_of(draft_.robot.left_tracks, "left_tracks", 1);
    sides.right = tracks_of(draft_.robot.right_tracks, "right_tracks", -1);
    if (!sides.any() || !draft_.mistakes.empty()) return;
    sides.belts = true;
    refuse_odom_link("left_tracks");
    const Vec3 left = middle_of(sides.left), right = middle_of(sides.right);
    sides.distance = left.y - right.y, sides.axle = 0.5 * (left.x + right.x);
    if (sides.distance <= 0) draft_.refuse_key("left_tracks", "the left tracks are not left of the right ones", "a larger y", "");
  }

  void add_wheels() {
    SideDrive& sides = draft_.made.model.sides;
    sides.left = wheels_of(draft_.robot.left_wheels, "left_wheels");
    sides.right = wheels_of(draft_.robot.right_wheels, "right_wheels");
    if (!sides.any()) return;
    refuse_odom_link("left_wheels");
    sides.radius = draft_.robot.wheel_radius;
    sides.distance = mean_place(sides.left).y - mean_place(sides.right).y;
    if (sides.distance <= 0) draft_.refuse_key("left_wheels", "the left wheels are not left of the right ones", "a larger y", "");
    refuse_rollers();
    if (draft_.mistakes.empty()) add_steering();
  }

 private:
  std::vector<int> wheels_of(const std::vector<std::string>& names, const char* member) {
    std::vector<int> wheels;
    for (const std::string& name : names) {
      const int joint = draft_.find_joint(name);
      if (joint < 0) {
        draft_.refuse_key(member, "the robot has no such joint that moves", "a joint of " + draft_.file.path, "\"" + name + "\"");
        continue;
      }
      const RobotJoint& wheel = draft_.made.model.joints[std::size_t(joint)];
      const Vec3 axis = zero_[std::size_t(wheel.child)].rotation.rotate(wheel.axis);
      if (wheel.kind != JointKind::hinge || axis.y < kLeftwards)
        draft_.refuse_key(member, "the axis of a wheel must point left", "+Y of the first link", "\"" + name + "\"");
      wheels.push_back(joint);
    }
    return wheels;
  }

  // Of one side: indices of the links. Their surface runs about the base's Y axis.
  std::vector<int> tracks_of(const std::vector<std::string>& names, const char* member, int side) {
    std::vector<int> tracks;
    std::vector<RobotLink>& links = draft_.made.model.links;
    for (const std::string& name : names) {
      const auto at = std::find_if(links.begin(), links.end(), [&](const RobotLink& link) { return link.name == name; });
      if (at == links.end()) {
        draft_.refuse_key(member, "the robot has no such link", "a link of " + draft_.file.path, "\"" + name + "\"");
        continue;
      }
      tracks.push_back(int(at - links.begin()));
      if (at->parts.empty())
        draft_.add_mistake(draft_.body_lines[std::size_t(tracks.back())], name, "a track has no <collision>, so it moves nothing", "a shape", "none");
      at->belt_axis = zero_[std::size_t(tracks.back())].rotation.conjugate().rotate({0, 1, 0});
      at->belt_speed_limit = draft_.robot.track_speed;
      at->belt_side = side;
    }
    return tracks;
  }

  // Of tracks, in the middle of their shapes.
  Vec3 middle_of(const std::vector<int>& tracks) const {
    Vec3 sum;
    for (const int track : tracks) {
      Aabb reach;
      for (const ConvexPart& part : draft_.made.model.links[std::size_t(track)].parts)
        for (const Vec3& p : part.points) reach.include(zero_[std::size_t(track)] * p);
      sum += (reach.min + reach.max) * 0.5;
    }
    return sum * (1 / double(tracks.size()));
  }

  // key: that gives the robot odometry.
  void refuse_odom_link(const std::string& key) {
    for (const UrdfLink& link : draft_.file.links)
      if (link.name == "odom") draft_.add_mistake(link.line, link.name, "is the frame of the odometry", "another name, or no `" + key + "`", "");
  }

  // Of a wheel's middle, in the base.
  Vec3 place_of(int wheel) const { return zero_[std::size_t(draft_.made.model.joints[std::size_t(wheel)].child)].translation; }
  Vec3 mean_place(const std::vector<int>& wheels) const {
    Vec3 sum;
    for (const int wheel : wheels) sum += place_of(wheel);
    return sum * (1 / double(wheels.size()));
  }

  // Of mecanum and omni wheels: these also roll sideways, and turn the robot by another law.
  void refuse_rollers() {
    const std::vector<RobotJoint>& joints = draft_.made.model.joints;
    for (const auto* side : {&draft_.made.model.sides.left, &draft_.made.model.sides.right})
      for (const int wheel : *side)
        for (const RobotJoint& roller : joints)
          if (roller.parent == joints[std::size_t(wheel)].child && roller.kind != JointKind::weld)
            return draft_.refuse_key(side == &draft_.made.model.sides.left ? "left_wheels" : "right_wheels",
                                     "the wheel has rollers: mecanum and omni wheels do not drive as these do; a function as `control` "
                                     "gives each wheel its speed",
                                     "wheels without joints of their own",
                                     "\"" + joints[std::size_t(wheel)].name + "\" with \"" + roller.name + "\"");
  }

  // The joints between the base and that one, nearest first.
  std::vector<int> chain_to(int joint) const {
    std::vector<int> chain;
    const std::vector<RobotJoint>& joints = draft_.made.model.joints;
    for (int link = joints[std::size_t(joint)].parent; link > 0; link = joints[std::size_t(link) - 1].parent) chain.push_back(link - 1);
    return chain;
  }

  // Those that are driven, and others that turn freely as they do, as high above the ground.
  std::vector<int> find_wheels() const {
    const SideDrive& sides = draft_.made.model.sides;
    std::vector<int> wheels = sides.left;
    wheels.insert(wheels.end(), sides.right.begin(), sides.right.end());
    const double height = mean_place(wheels).z;
    for (int i = 0; i < int(draft_.made.model.joints.size()); ++i) {
      const RobotJoint& joint = draft_.made.model.joints[std::size_t(i)];
      const Vec3 axis = zero_[std::size_t(joint.child)].rotation.rotate(joint.axis);
      if (joint.kind == JointKind::hinge && std::abs(axis.y) > kLeftwards && !(joint.upper - joint.lower < kNever) &&
          std::abs(place_of(i).z - height) < 0.5 * sides.radius && std::find(wheels.begin(), wheels.end(), i) == wheels.end())
        wheels.push_back(i);
    }
    return wheels;
  }

  // Turns about the vertical axis within limits, by a motor. What turns round and round is a castor's.
  double steering_sign(int joint) const {
    const RobotJoint& j = draft_.made.model.joints[std::size_t(joint)];
    const double up = zero_[std::size_t(j.child)].rotation.rotate(j.axis).z;
    return j.kind == JointKind::hinge && std::abs(up) > kUpwards && j.upper - j.lower < kNever && j.motor.effort > 0 ? std::copysign(1.0, up)
                                                                                                                    : 0;
  }

  // A robot with steered wheels is a car. If `steering` does not say so, it would be dragged sideways over them.
  void add_steering() {
    SideDrive& sides = draft_.made.model.sides;
    std::vector<int> steering, fixed_driven, fixed_others;
    for (const std::string& name : draft_.robot.steering) {
      steering.push_back(draft_.find_joint(name));
      if (steering.back() < 0 || steering_sign(steering.back()) == 0)
        return draft_.refuse_key("steering", "not a joint that steers: a hinge about the vertical axis, with limits and an effort",
                          "such a joint of " + draft_.file.path, "\"" + name + "\"");
    }
    const std::size_t driven = sides.left.size() + sides.right.size();
    const std::vector<int> wheels = find_wheels();
    for (std::size_t k = 0; k < wheels.size(); ++k) {
      const std::vector<int> chain = chain_to(wheels[k]);
      const auto steers = std::find_if(chain.begin(), chain.end(), [&](int joint) { return steering_sign(joint) != 0; });
      if (steers == chain.end()) {
        (k < driven ? fixed_driven : fixed_others).push_back(wheels[k]);
        continue;
      }
      const std::string& name = draft_.made.model.joints[std::size_t(*steers)].name;
      if (std::find(steering.begin(), steering.end(), *steers) == steering.end())
        return draft_.refuse_key("steering", "the joint steers the wheel `" + draft_.made.model.joints[std::size_t(wheels[k])].name + "`",
                          "\"" + name + "\" in `steering`", draft_.robot.steering.empty() ? "no `steering`" : "others");
      const Vec3 place = place_of(wheels[k]);
      sides.steered.push_back({*steers, steering_sign(*steers), place.x, place.y, k < driven ? wheels[k] : -1});
    }
    const std::vector<int>& axle = !fixed_driven.empty() ? fixed_driven : !fixed_others.empty() && !steering.empty() ? fixed_others : wheels;
    sides.axle = mean_place(axle).x;
    for (const int joint : steering) {
      const auto wheel = std::find_if(sides.steered.begin(), sides.steered.end(), [&](const SteeredWheel& w) { return w.joint == joint; });
      const bool ahead = wheel != sides.steered.end() && std::abs(wheel->x - sides.axle) > 0.1 * sides.radius;
      if (ahead) continue;
      return draft_.refuse_key("steering", wheel == sides.steered.end() ? "the joint carries no wheel" : "its wheel is on the axle that does not turn",
                        "a joint that steers a wheel before or behind the others", "\"" + draft_.made.model.joints[std::size_t(joint)].name + "\"");
    }
  }

  UrdfDraft& draft_;
  const std::vector<Pose> zero_;  // of the bodies in the base, at the joints' zeros
};

}  // namespace

void add_tracks(UrdfDraft& draft) {
  if (!draft.robot.left_tracks.empty()) Drive(draft).add_tracks();
}

void add_wheels(UrdfDraft& draft) {
  if (!draft.robot.left_wheels.empty()) Drive(draft).add_wheels();
}

}  // namespace rubble
