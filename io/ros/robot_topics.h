// What a recording says of its robots in ROS's terms. Names: of the only robot as they stand here, of
// several with NAME/ before topics and frames.
//
//   /joint_states         sensor_msgs/JointState: encoders and the motors' efforts, of all joints that move
//   /odom                 nav_msgs/Odometry: odom -> base frame, from belts or wheels; where it has them
//   /ground_truth/odom    nav_msgs/Odometry: world -> base frame, the truth
//   /contacts             geometry_msgs/WrenchStamped: one a link, of all that touches it, in its frame
//   /robot_description    std_msgs/String: URDF, latched
//   /tf                   odom -> base frame as in /odom, without odometry world -> base frame; each moving
//                         joint's parent link -> child link, by the encoders
//   /tf_static            world -> odom, where the robot started; welded links
#pragma once

#include <cstdint>
#include <vector>

#include "io/recording/recording.h"
#include "io/ros/ros_messages.h"
#include "render/scene/robot_sample.h"

namespace rubble {

class RosFile;

class RobotTopics {
 public:
  // Adds the topics to the file, which must outlive this.
  RobotTopics(const std::vector<RobotRecord>& robots, RosFile& file);

  // What holds all the time; before the first sample.
  void add_transforms(std::vector<ros::Transform>& fixed) const;
  void write_descriptions(std::int64_t stamp_ns);

  void write(const RobotSample& sample, std::uint32_t tf_topic);

 private:
  struct Topics {
    std::uint32_t joints = 0, odometry = 0, truth = 0, contacts = 0, description = 0;
    std::uint32_t samples = 0;  // so far
  };
  void write_joints(const RobotRecord& robot, Topics& topics, const RobotSample& sample);
  void write_transforms(const RobotRecord& robot, std::uint32_t count, const RobotSample& sample,
                        std::uint32_t tf_topic);

  std::vector<RobotRecord> robots_;
  RosFile& file_;
  std::vector<Topics> topics_;
};

}  // namespace rubble
