#include "app/robots/robot_log.h"

#include <algorithm>
#include <set>

#include "io/robot/urdf_writer.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "scripting/scenario/camera_mistakes.h"

namespace rubble {
namespace {

RobotSample::Odometry describe(const OdometryReading& reading) {
  RobotSample::Odometry odometry;
  odometry.odom_from_base = {portable::quat_from_rpy(0, 0, reading.yaw), {reading.x, reading.y, 0}};
  odometry.linear = reading.linear, odometry.angular = reading.angular;
  odometry.covariance = reading.covariance;
  odometry.linear_variance = reading.linear_variance, odometry.angular_variance = reading.angular_variance;
  return odometry;
}

// About the link's origin instead of its centre of mass, in its frame.
RobotSample::Wrench wrench_of(const RobotState::Link& link, const Vec3& centre_of_mass) {
  const Quat to_link = link.world_from_link.rotation.conjugate();
  const Vec3 force = to_link.rotate(link.contact_force);
  return {force, to_link.rotate(link.contact_moment) + cross(centre_of_mass, force)};
}

Pose parent_from_child(const std::vector<Pose>& base_from_links, const RobotJoint& joint) {
  return base_from_links[std::size_t(joint.parent)].inverse() *
         base_from_links[std::size_t(joint.child)];
}

}  // namespace

RobotLog::RobotLog(const RobotModel& model, std::int64_t start_ns, const OdometryNoise& noise)
    : model_(&model), number_(noise.robot), start_ns_(start_ns) {
  if (model.sides.any()) wheels_.emplace(model, noise);
}

void RobotLog::note(const RobotSense& sense) {
  const RobotState& state = sense.state;
  RobotSample sample;
  sample.stamp_ns = start_ns_ + std::int64_t(sense.time * 1e9 + 0.5);
  sample.sensor = number_;
  for (const RobotState::Joint& joint : state.joints) {
    sample.positions.push_back(joint.position);
    sample.speeds.push_back(joint.speed);
    sample.efforts.push_back(joint.torque);
  }
  const std::vector<Pose> links = calc_base_from_links(*model_, sample.positions);
  for (const RobotJoint& joint : model_->joints) {
    // Links that have not grown are not where joints would put them.
    const auto world = [&](int link) { return state.links[std::size_t(link)].world_from_link; };
    sample.parent_from_child.push_back(model_->tube ? world(joint.parent).inverse() * world(joint.child)
                                                    : parent_from_child(links, joint));
  }
  for (std::size_t i = 0; i < state.links.size(); ++i)
    sample.contacts.push_back(wrench_of(state.links[i], model_->links[i].centre_of_mass));
  const RobotState::Link& base = state.links[0];
  const Quat to_base = base.world_from_link.rotation.conjugate();
  sample.world_from_base = base.world_from_link;
  sample.linear_velocity = to_base.rotate(base.linear);
  sample.angular_velocity = to_base.rotate(base.angular);
  if (wheels_) {
    odometry_.push_back(wheels_->update(state, sense.time));
    sample.odometry = describe(odometry_.back());
  }
  samples_.push_back(sample);
}

namespace {

// Names of links and frames, as TF has them.
std::vector<std::string> plain_frames(const RobotModel& model) {
  std::vector<std::string> names;
  const RobotRecord record;
  for (const RobotLink& link : model.links) names.push_back(record.frame_named(link.name));
  for (const RobotFrame& frame : model.frames) names.push_back(record.frame_named(frame.name));
  return names;
}

// several: its topics have a prefix. prefixed: its frames have one.
RobotRecord describe_robot(const MissionRobot& robot, const std::string& name, const Pose& world_from_base, bool several,
                           bool prefixed) {
  const RobotModel& model = robot.model;
  RobotRecord record;
  record.name = name;
  if (several) record.topic = "/" + name;
  if (prefixed) record.frame = name + "/";
  for (const RobotLink& link : model.links) {
    record.links.push_back(link.name);
    record.instances.push_back(model.name + "/" + link.name);
  }
  const std::vector<Pose> links = calc_base_from_links(model);
  for (const RobotJoint& joint : model.joints) {
    record.joints.push_back({joint.name, joint.parent, joint.child, joint.kind == JointKind::weld});
    record.parent_from_child.push_back(parent_from_child(links, joint));
  }
  for (const RobotFrame& frame : model.frames) {
    record.joints.push_back({frame.name + "_frame", frame.link, int(record.links.size()), true});
    record.links.push_back(frame.name);
    record.parent_from_child.push_back(frame.link_from_frame);
  }
  record.world_from_base = world_from_base;
  record.has_odometry = model.sides.any();
  record.description = robot_to_urdf(model, name, std::string("package://") + kRobotsPackage + "/" + name + "_meshes",
                                     record.frame, world_from_base);
  return record;
}

// What the prefix cannot part: the mission gave a sensor such a name, or two links differ by slashes in front alone.
void check_frames(const RobotRecord& record, const std::vector<std::string>& taken, const std::string& key) {
  std::set<std::string> frames(taken.begin(), taken.end());
  if (record.has_odometry) frames.insert(record.frame + "odom");
  for (std::size_t i = 0; i < record.links.size(); ++i)
    if (!frames.insert(record.frame_of(int(i))).second)
      throw InputError({"", 0, key, "two frames of /tf would have one name", "another name for the sensor or the link",
                        "\"" + record.frame_of(int(i)) + "\"", ""});
}

}  // namespace

std::string find_frame_clash(const Scenario& scenario, const MissionRobot& robot) {
  const std::vector<std::string> taken = list_sensor_frames(scenario);
  for (const std::string& name : plain_frames(robot.model))
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) return name;
  return "";
}

std::vector<RobotRecord> describe_robots(const Scenario& scenario, const std::vector<MissionRobot>& made) {
  const std::vector<std::string> names = robot_names(scenario.robots), taken = list_sensor_frames(scenario);
  const bool several = made.size() > 1;
  std::vector<RobotRecord> records;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const bool prefixed = several || !find_frame_clash(scenario, made[i]).empty();
    records.push_back(describe_robot(made[i], names[i], calc_base_pose(scenario.robots[i], made[i]), several, prefixed));
    std::vector<std::string> others;
    for (const std::string& name : taken)
      if (name != records.back().frame + "odom") others.push_back(name);
    check_frames(records.back(), others, "robots[" + std::to_string(i + 1) + "]");
  }
  return records;
}

}  // namespace rubble
