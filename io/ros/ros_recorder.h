// What a recording says in ROS's terms, the same for ROS 1 bags and ROS 2 MCAP files.
//
//   /camera/rgb/image_raw (rgb8), /camera/rgb/camera_info
//   /camera/depth_registered/image_raw (16UC1, mm, 0: no return)
//     or /camera/depth_registered/image (32FC1, m, NaN: no return), and .../camera_info
//   /ground_truth/pose    the rig that carries the sensors in `world`: of a single camera its body
//   /tf                   world -> camera_link
//   /tf_static            camera_link -> camera_optical_frame, latched
//   /clock
// Where the recording has them:
//   /camera/right/image_raw, .../camera_info   in camera_right_optical_frame; P[3] = -fx baseline
//   /camera/events              dvs_msgs/EventArray, at the frame's stamp, those since the one before
//   /imu                        sensor_msgs/Imu, each at its own stamp
//   /points                     sensor_msgs/PointCloud2, a scan at the stamp of its first ray
//   /scan                       sensor_msgs/LaserScan, of a 2-D scanner
//   /NAME                       other sensors, in the messages of their kinds (docs/reference/sensors.md)
//   /ground_truth/depth/image   32FC1, m: exact, where the depth above is that of a sensor
//   /NAME/ground_truth/pose     geometry_msgs/PoseStamped of a camera on a robot: its body in `world`
//   /ground_truth/NAME/image    streams of ground truth, by their names and in the encodings that their
//                               types have; a piece number is 32SC1: -1: ground; -2: nothing
//   /ground_truth/NAME/colours/image   in its place, where vectors are colours: rgb8 (io/ros/vector_colours.h)
//   /ground_truth/legend        std_msgs/String, JSON (legend_to_json), latched
//   robots                      io/ros/robot_topics.h; where one carries the rig, that hangs on its link in
//                               /tf_static instead of on the world in /tf
// Several cameras: /NAME in the place of /camera, /NAME/ground_truth in that of /ground_truth but for
// the pose and the legend; world -> base_link in /tf, base_link -> NAME_link -> NAME_optical_frame in
// /tf_static. Other names: CameraRecord and ImuRecord. /clock, /tf and the pose come once an instant.
// With compressed pictures colour is in .../image_raw/compressed and 16UC1 depth in
// .../image_raw/compressedDepth, as image_transport does it. Pictures are in camera_optical_frame.
// All that belongs to a frame bears its one stamp.
#pragma once

#include <memory>
#include <string>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"
#include "io/ros/ros_messages.h"

namespace rubble {

enum class RosDepth {
  millimetres,  // 16UC1: half the size, up to 65.535 m
  metres,       // 32FC1: exactly what was rendered
};

enum class RosPictures {
  raw,
  png,   // lossless; half the size, and many times the time
  jpeg,  // colour only, with losses; depth becomes PNG
};

struct RosOptions {
  RosDepth depth = RosDepth::millimetres;   // encoding of depth images
  RosPictures pictures = RosPictures::raw;  // compression of pictures
  Recording recording;                      // what is recorded, and under which names
  bool vector_colours = false;              // streams of several values as rgb8, in .../NAME/colours/image
};

// A file that holds ROS messages.
class RosFile {
 public:
  virtual ~RosFile() = default;
  virtual ros::Version version() const = 0;
  // All topics come before the first message. Returns a number for write().
  virtual std::uint32_t add(const std::string& topic, const ros::MessageType& type,
                            bool latched) = 0;
  virtual void write(std::uint32_t topic, std::int64_t stamp_ns, std::string_view message) = 0;
  virtual void finish() = 0;
};

// `path` names the recording in errors. Stamps must be later than 0.
std::unique_ptr<Recorder> make_ros_recorder(const std::string& path, std::unique_ptr<RosFile> file,
                                            const RosOptions& options);

}  // namespace rubble
