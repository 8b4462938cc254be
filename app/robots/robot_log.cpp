#include "app/robots/robot_log.h"

#include "io/robot/urdf_writer.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

RobotSample::Odometry describe(const OdometryReading& reading) {
  RobotSample::Odometry odometry;
  odometry.odom_from_base = {portable::quat_from_rpy(0, 0, reading.yaw), {reading.x, reading.y, 0}};
  odometry.linear = reading.linear, odometry.angular = reading.angular;
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

RobotRecord describe_robot(const MissionRobot& robot, const std::string& name,
                           const Pose& world_from_base, bool several) {
  const RobotModel& model = robot.model;
  RobotRecord record;
  record.name = name;
  if (several) record.topic = "/" + name, record.frame = name + "/";
  for (const RobotLink& link : model.links) record.links.push_back(link.name);
  const std::vector<Pose> links = calc_base_from_links(model);
  for (const RobotJoint& joint : model.joints) {
    record.joints.push_back({joint.name, joint.parent, joint.child, joint.kind == JointKind::weld});
    record.parent_from_child.push_back(parent_from_child(links, joint));
  }
  for (const RobotFrame& frame : robot.frames) {
    record.joints.push_back({frame.name + "_frame", frame.link, int(record.links.size()), true});
    record.links.push_back(frame.name);
    record.parent_from_child.push_back(frame.link_from_frame);
  }
  record.world_from_base = world_from_base;
  record.has_odometry = model.sides.any();
  record.description = robot_to_urdf(model, name, name + "_meshes", record.frame, robot.frames);
  return record;
}

}  // namespace rubble
