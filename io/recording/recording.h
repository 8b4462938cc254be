// Data common to all samples of a recording: the sensors, their poses on the rig, their streams and names, and the
// meaning of numbers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/recording/reading_format.h"
#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"

namespace rubble {

// Optional streams of a camera in a recording, besides colour and depth. A recorder requires the chosen ones in every
// frame, and leaves out the others.
struct Channels {
  bool right = false;           // Frame::rgb_right
  bool measured_depth = false;  // depth topics and files have the measured depth; exact depth is stored as
                                // ground truth, where a format has a place for it
  bool events = false;          // of an event camera
  StreamSet truth;              // images of ground truth, in the order of image_streams()

  // Whether a stream has numbers of pieces or classes, which the legend explains.
  bool has_legend() const;
};

// Meaning of the numbers in the streams `label` and `instance`.
struct Legend {
  struct Piece {
    std::uint16_t label = 0;  // class, as in the stream `label`
    std::string asset;        // name of its type
    bool victim = false;      // whether it is a person
  };
  std::vector<std::string> labels;  // by label: "sky", "ground", then the assets
  std::vector<Piece> pieces;        // by piece number
  std::vector<Piece> fines;         // heaps of fines, numbered from ...
  std::uint32_t first_fine = 0;     // ... this number on
  std::vector<Piece> surroundings;  // surrounding things, numbered from ...
  std::uint32_t first_surrounding = 0;  // ... this number on
};

// The legend as JSON: {"labels": [{"label", "name"}], "instances": [{"instance", "label", "name"}],
// "ground_instance", "no_instance"}.
std::string legend_to_json(const Legend& legend);

// The link of a robot that carries a sensor or the rig.
struct RigMount {
  std::string parent;    // TF: the link
  Pose parent_from_rig;  // unit: m; unused for a sensor, which has a pose of its own
};

// A camera. Frame::sensor is its number. The defaults are those of a single camera, which is the rig itself.
struct CameraRecord {
  std::string name = "camera";                // of labels and folders
  std::string topic = "/camera";              // ROS: prefix of its topics
  std::string truth_topic = "/ground_truth";  // ROS: prefix of its topics of ground truth
  std::string link = "camera_link";           // TF: its body (X forward, Y left, Z up)
  std::string optical = "camera_optical_frame";              // TF: its images (Z forward)
  std::string right_optical = "camera_right_optical_frame";  // TF: images of the right camera
  std::string carrier;                        // TF: the link that carries it; empty: the rig
  Pose rig_from_camera;                       // of its body, or in the link
  double baseline = 0;                        // as Frame::baseline; unit: m
  Channels channels;                          // besides colour and depth

  bool is_rig() const;  // whether its pose is that of the rig
  // Converts a pose in the body of the camera to the frame of the rig.
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

// A sensor of another kind. Reading::sensor is its number.
struct SensorRecord {
  std::string name;      // of labels, files and folders
  std::string topic;     // ROS: prefix of its topics
  std::string frame_id;  // TF
  std::string carrier;   // TF: the link that carries it; empty: the rig
  Pose rig_from_sensor;  // or in the link; axes: X forward, Y left, Z up
  std::shared_ptr<const ReadingFormat> format;  // never null

  bool scans() const { return format->most_points() > 0; }  // whether its readings are scans
};

// A robot. RobotSample::sensor is its number.
struct RobotRecord {
  struct Joint {
    std::string name;
    int parent = 0, child = 1;  // numbers of links
    bool fixed = false;         // a weld
  };

  std::string name = "robot";  // of labels
  std::string topic;           // ROS: prefix of its topics, "/NAME"; empty for a single robot
  // TF: prefix of its frames, "NAME/"; empty if no other frame has the name of one of its links
  std::string frame;
  std::vector<std::string> links;
  std::vector<Joint> joints;
  std::vector<Pose> parent_from_child;  // by joint, at the start
  Pose world_from_base;                 // of its first link at the start: the origin of odometry
  bool has_odometry = false;
  std::string description;  // URDF

  std::string frame_of(int link) const { return frame_named(links[std::size_t(link)]); }
  // TF: frame of the link of this name. tf2 refuses leading slashes.
  std::string frame_named(const std::string& link) const {
    return frame + link.substr(std::min(link.size(), link.find_first_not_of('/')));
  }
};

struct Recording {
  std::string rig = "camera_link";       // TF: frame that follows the trajectory
  std::vector<CameraRecord> cameras{1};  // at least one
  std::vector<ImuRecord> imus;           // empty without inertial units
  std::vector<SensorRecord> sensors;
  std::vector<RobotRecord> robots;
  std::optional<RigMount> mount;         // of the rig, on a robot
  Legend legend;                         // if a stream of ground truth has one

  // TF: parent frame of a sensor with this carrier.
  const std::string& frame_of(const std::string& carrier) const { return carrier.empty() ? rig : carrier; }
  bool has_legend() const;  // whether a camera has such a stream
  // The same recording with this camera alone, and with the inertial units beside it.
  Recording of_camera(std::size_t camera) const;
};

}  // namespace rubble
