#include "io/ros/robot_topics.h"

#include "io/ros/ros_recorder.h"

namespace rubble {
namespace {

constexpr char kOdom[] = "odom";

}  // namespace

RobotTopics::RobotTopics(const std::vector<RobotRecord>& robots, RosFile& file)
    : robots_(robots), file_(file) {
  for (const RobotRecord& robot : robots_) {
    Topics& topics = topics_.emplace_back();
    topics.joints = file_.add(robot.topic + "/joint_states", ros::kJointState, false);
    if (robot.has_odometry) topics.odometry = file_.add(robot.topic + "/odom", ros::kOdometry, false);
    topics.truth = file_.add(robot.topic + "/ground_truth/odom", ros::kOdometry, false);
    topics.contacts = file_.add(robot.topic + "/contacts", ros::kWrenchStamped, false);
    topics.description = file_.add(robot.topic + "/robot_description", ros::kString, true);
  }
}

void RobotTopics::add_transforms(std::vector<ros::Transform>& fixed) const {
  for (const RobotRecord& robot : robots_) {
    if (robot.has_odometry) fixed.push_back({robot.frame + kOdom, robot.world_from_base, ros::kWorld});
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const RobotRecord::Joint& joint = robot.joints[i];
      if (!joint.fixed) continue;
      fixed.push_back(
          {robot.frame_of(joint.child), robot.parent_from_child[i], robot.frame_of(joint.parent)});
    }
  }
}

void RobotTopics::write_descriptions(std::int64_t stamp_ns) {
  for (std::size_t i = 0; i < robots_.size(); ++i)
    file_.write(topics_[i].description, stamp_ns,
                ros::string(file_.version(), robots_[i].description));
}

void RobotTopics::write(const RobotSample& sample, std::uint32_t tf_topic) {
  const auto i = std::size_t(sample.sensor);
  const RobotRecord& robot = robots_.at(i);
  Topics& topics = topics_[i];
  const ros::Version version = file_.version();
  const auto header = [&](const std::string& frame) {
    return ros::Header{topics.samples, sample.stamp_ns, frame};
  };
  write_joints(robot, topics, sample);
  const std::string base = robot.frame_of(0);
  if (sample.odometry) {
    file_.write(topics.odometry, sample.stamp_ns,
                ros::odometry(version, header(robot.frame + kOdom), base, *sample.odometry));
  }
  file_.write(topics.truth, sample.stamp_ns,
              ros::true_odometry(version, header(ros::kWorld), base, sample.world_from_base,
                                 sample.linear_velocity, sample.angular_velocity));
  for (std::size_t k = 0; k < sample.contacts.size(); ++k)
    file_.write(topics.contacts, sample.stamp_ns,
                ros::wrench_stamped(version, header(robot.frame_of(int(k))), sample.contacts[k].force,
                                    sample.contacts[k].moment));
  write_transforms(robot, topics.samples, sample, tf_topic);
  ++topics.samples;
}

void RobotTopics::write_joints(const RobotRecord& robot, Topics& topics, const RobotSample& sample) {
  std::vector<std::string> names;
  std::vector<double> positions, speeds, efforts;
  for (std::size_t k = 0; k < robot.joints.size(); ++k) {
    if (robot.joints[k].fixed) continue;
    names.push_back(robot.joints[k].name);
    positions.push_back(sample.positions[k]);
    speeds.push_back(sample.speeds[k]);
    efforts.push_back(sample.efforts[k]);
  }
  const ros::Header header{topics.samples, sample.stamp_ns, robot.frame_of(0)};
  file_.write(topics.joints, sample.stamp_ns,
              ros::joint_state(file_.version(), header, names, positions, speeds, efforts));
}

void RobotTopics::write_transforms(const RobotRecord& robot, std::uint32_t count,
                                   const RobotSample& sample, std::uint32_t tf_topic) {
  std::vector<ros::Transform> list;
  const std::string base = robot.frame_of(0);
  if (sample.odometry)
    list.push_back({base, sample.odometry->odom_from_base, robot.frame + kOdom});
  else
    list.push_back({base, sample.world_from_base, ros::kWorld});
  for (std::size_t k = 0; k < robot.joints.size(); ++k) {
    const RobotRecord::Joint& joint = robot.joints[k];
    if (joint.fixed) continue;
    list.push_back(
        {robot.frame_of(joint.child), sample.parent_from_child[k], robot.frame_of(joint.parent)});
  }
  file_.write(tf_topic, sample.stamp_ns,
              ros::transforms(file_.version(), {count, sample.stamp_ns, ros::kWorld}, list));
}

}  // namespace rubble
