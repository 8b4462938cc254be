#include "io/rosbag_recorder.h"

#include "io/bag_writer.h"
#include "io/depth_encoding.h"
#include "io/frame_order.h"
#include "io/ros_messages.h"

namespace rubble {
namespace {

constexpr char kWorld[] = "world";
constexpr char kCamera[] = "camera_link";
constexpr char kOptical[] = "camera_optical_frame";

class RosbagRecorder : public Recorder {
 public:
  RosbagRecorder(const std::string& path, const RosbagOptions& options)
      : bag_(path, options.compress ? BagCompression::lz4 : BagCompression::none),
        order_(path),
        depth_(options.depth),
        clock_(add("/clock", ros::kClock)),
        tf_static_(add("/tf_static", ros::kTfMessage, true)),
        tf_(add("/tf", ros::kTfMessage)),
        pose_(add("/ground_truth/pose", ros::kPoseStamped)),
        rgb_info_(add("/camera/rgb/camera_info", ros::kCameraInfo)),
        rgb_(add("/camera/rgb/image_raw", ros::kImage)),
        depth_info_(add("/camera/depth_registered/camera_info", ros::kCameraInfo)),
        depth_image_(add(depth_ == BagDepth::millimetres ? "/camera/depth_registered/image_raw"
                                                         : "/camera/depth_registered/image",
                         ros::kImage)) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    write_clock_and_poses(frame);
    const ros::Header optical = header(frame, kOptical);
    const std::string info = ros::camera_info(optical, frame.intrinsics);
    bag_.write(rgb_info_, frame.stamp_ns, info);
    bag_.write(rgb_, frame.stamp_ns,
               ros::image(optical, frame.intrinsics, "rgb8", 3, frame.rgb.data()));
    bag_.write(depth_info_, frame.stamp_ns, info);
    bag_.write(depth_image_, frame.stamp_ns, depth_message(optical, frame));
  }

  void finish() override { bag_.finish(); }

 private:
  std::uint32_t add(const char* topic, const ros::MessageType& type, bool latching = false) {
    return bag_.add_connection({topic, type.name, type.md5, type.definition, latching});
  }

  static ros::Header header(const Frame& frame, const char* frame_id) {
    return {static_cast<std::uint32_t>(frame.index), frame.stamp_ns, frame_id};
  }

  void write_clock_and_poses(const Frame& frame) {
    const std::int64_t stamp = frame.stamp_ns;
    bag_.write(clock_, stamp, ros::clock(stamp));
    if (frame.index == 0) {
      bag_.write(tf_static_, stamp,
                 ros::transform(header(frame, kCamera), kOptical, camera_from_optical));
    }
    const ros::Header world = header(frame, kWorld);
    bag_.write(tf_, stamp, ros::transform(world, kCamera, frame.world_from_camera));
    bag_.write(pose_, stamp, ros::pose_stamped(world, frame.world_from_camera));
  }

  std::string depth_message(const ros::Header& optical, const Frame& frame) const {
    if (depth_ == BagDepth::metres) {
      return ros::image(optical, frame.intrinsics, "32FC1", 4, frame.depth.data());
    }
    const auto millimetres = encode_depth(frame.depth, 0.001);
    return ros::image(optical, frame.intrinsics, "16UC1", 2, millimetres.data());
  }

  BagWriter bag_;
  FrameOrder order_;
  BagDepth depth_;
  // Numbers of the connections, in the order of the file.
  std::uint32_t clock_, tf_static_, tf_, pose_, rgb_info_, rgb_, depth_info_, depth_image_;
};

}  // namespace

std::unique_ptr<Recorder> make_rosbag_recorder(const std::string& path,
                                               const RosbagOptions& options) {
  return std::make_unique<RosbagRecorder>(path, options);
}

}  // namespace rubble
