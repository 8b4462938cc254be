// What is the same for all samples of a recording: which sensors there are, where they are on the rig
// that carries them, what each gives, under which names, and what numbers mean.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"
#include "render/scene/lidar_spec.h"

namespace rubble {

// The optional streams of a camera that a recording holds, besides colour and depth. A recorder demands
// those that are set, of every frame, and leaves out the others.
struct Channels {
  bool right = false;           // Frame::rgb_right
  bool measured_depth = false;  // then the depth topics and files are what the sensor measures, and
                                // the exact depth goes where each format has its ground truth
  bool events = false;          // of an event camera
  StreamSet truth;              // images of ground truth, in the order of image_streams()

  // Whether one of them holds numbers of pieces or classes, which the legend explains.
  bool has_legend() const;
};

// What the numbers in the streams `label` and `instance` stand for.
struct Legend {
  struct Piece {
    std::uint16_t label = 0;  // class, as in the stream `label`
    std::string asset;        // name of its type
  };
  std::vector<std::string> labels;  // by label: "sky", "ground", then the assets
  std::vector<Piece> pieces;        // by piece number
  std::vector<Piece> fines;         // heaps of fines, the first of which has the number ...
  std::uint32_t first_fine = 0;     // ... this
  std::vector<Piece> surroundings;  // things about the pile, the first of which has the number ...
  std::uint32_t first_surrounding = 0;  // ... this
};

// The legend as JSON: {"labels": [{"label", "name"}], "instances": [{"instance", "label", "name"}],
// "ground_instance", "no_instance"}.
std::string legend_to_json(const Legend& legend);

// What carries a sensor or the rig, where that is a link of a robot.
struct RigMount {
  std::string parent;    // TF: the link
  Pose parent_from_rig;  // unit: m; of a sensor nothing: it has a pose of its own
};

// A camera. Frame::sensor is its number. The defaults are those of a mission's only camera, which is
// the rig itself.
struct CameraRecord {
  std::string name = "camera";                // of labels and folders
  std::string topic = "/camera";              // ROS: what its topics begin with
  std::string truth_topic = "/ground_truth";  // ROS: likewise, of its ground truth
  std::string link = "camera_link";           // TF: its body (X forward, Y left, Z up)
  std::string optical = "camera_optical_frame";              // TF: its pictures (Z forward)
  std::string right_optical = "camera_right_optical_frame";  // TF: those of the right camera
  std::string carrier;                        // TF: the link that carries it; empty: the rig
  Pose rig_from_camera;                       // of its body, or in the link
  double baseline = 0;                        // as Frame::baseline; unit: m
  Channels channels;                          // besides colour and depth

  bool is_rig() const;  // whether it is where the rig is, unturned
  // What is placed in its body, in the frame of the rig.
  Pose in_rig(const Pose& camera_from_it) const;
};

// An inertial unit. ImuSample::sensor is its number.
struct ImuRecord {
  std::string name = "imu";               // of labels
  std::string topic = "/imu";             // ROS
  std::string frame_id = "camera_link";   // TF
  std::string carrier;                    // TF: the link that carries it; empty: the rig
  Pose rig_from_imu;                      // or in the link; axes: X forward, Y left, Z up
  ImuModel model;                         // rate and noise
};

// A LiDAR. LidarScan::sensor is its number.
struct LidarRecord {
  std::string name = "lidar";      // of labels and folders
  std::string topic = "/points";   // ROS: PointCloud2, of a planar pattern LaserScan
  std::string frame_id = "lidar_link";  // TF
  std::string carrier;             // TF: the link that carries it; empty: the rig
  Pose rig_from_lidar;             // or in the link; axes: X forward, Y left, Z up
  LidarSpec spec;                  // pattern and limits
};

// A robot. RobotSample::sensor is its number.
struct RobotRecord {
  struct Joint {
    std::string name;
    int parent = 0, child = 1;  // numbers of links
    bool fixed = false;         // a weld
  };

  std::string name = "robot";  // of labels
  std::string topic;           // ROS: what its topics begin with, "/NAME"; of the only robot nothing
  // TF: what its frames begin with, "NAME/"; nothing, if no other frame has the name of one of its links
  std::string frame;
  std::vector<std::string> links;
  std::vector<Joint> joints;
  std::vector<Pose> parent_from_child;  // by joint, at the start
  Pose world_from_base;                 // of its first link at the start; there odometry has its origin
  bool has_odometry = false;
  std::string description;  // URDF

  std::string frame_of(int link) const { return frame_named(links[std::size_t(link)]); }
  // TF: of the link of that name. tf2 refuses slashes in front.
  std::string frame_named(const std::string& link) const {
    return frame + link.substr(std::min(link.size(), link.find_first_not_of('/')));
  }
};

struct Recording {
  std::string rig = "camera_link";       // TF: what flies the trajectory
  std::vector<CameraRecord> cameras{1};  // at least one
  std::vector<ImuRecord> imus;           // none where the mission has no inertial unit
  std::vector<LidarRecord> lidars;
  std::vector<RobotRecord> robots;
  std::optional<RigMount> mount;         // of the rig, on a robot
  Legend legend;                         // where a stream of ground truth has one

  // TF: what a sensor with that carrier is fixed to.
  const std::string& frame_of(const std::string& carrier) const { return carrier.empty() ? rig : carrier; }
  bool has_legend() const;  // whether any camera gives such a stream
  // The same with one of the cameras alone, as the first, and of the inertial units those beside it.
  Recording of_camera(std::size_t camera) const;
};

}  // namespace rubble
