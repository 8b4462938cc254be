#include "io/ros/ros_recorder.h"

#include <algorithm>

#include "io/image/depth_encoding.h"
#include "io/image/image_file.h"
#include "io/image/jpeg_file.h"
#include "io/recording/frame_order.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

constexpr char kWorld[] = "world";
constexpr char kCamera[] = "camera_link";
constexpr char kOptical[] = "camera_optical_frame";
constexpr char kRightOptical[] = "camera_right_optical_frame";

// In front of a picture of 16UC1 in compressedDepth: a number of the method and two parameters,
// both for depth in metres alone.
constexpr std::size_t kCompressedDepthHeader = 12;  // unit: byte

// In a file, images of numbers come after those of floats.
StreamSet floats_first(StreamSet streams) {
  std::stable_partition(streams.begin(), streams.end(), [](const ImageStream* stream) {
    return std::holds_alternative<PixelMaker<float>>(stream->make);
  });
  return streams;
}

class RosRecorder : public Recorder {
 public:
  RosRecorder(const std::string& path, std::unique_ptr<RosFile> file, const RosOptions& options)
      : file_(std::move(file)),
        version_(file_->version()),
        options_(options),
        channels_(options.recording.channels),
        truth_(floats_first(channels_.truth)),
        order_(path, channels_) {
    add_common_topics();
    add_channel_topics();
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    write_imu(frame);
    write_clock_and_poses(frame);
    write_camera(frame, rgb_info_, rgb_, kOptical, frame.rgb, 0);
    if (channels_.right)
      write_camera(frame, right_info_, right_, kRightOptical, frame.rgb_right, frame.baseline);
    write_depth(frame);
    write_ground_truth(frame);
    if (channels_.events) {
      send(events_, frame,
           ros::event_array(version_, header(frame, kOptical), frame.intrinsics, frame.events));
    }
  }

  void finish() override { file_->finish(); }

 private:
  bool compressed() const { return options_.pictures != RosPictures::raw; }
  bool packed_depth() const { return compressed() && options_.depth == RosDepth::millimetres; }

  void add_common_topics() {
    const std::string depth = "/camera/depth_registered/";
    clock_ = file_->add("/clock", ros::kClock, false);
    tf_static_ = file_->add("/tf_static", ros::kTfMessage, true);
    tf_ = file_->add("/tf", ros::kTfMessage, false);
    pose_ = file_->add("/ground_truth/pose", ros::kPoseStamped, false);
    rgb_info_ = file_->add("/camera/rgb/camera_info", ros::kCameraInfo, false);
    rgb_ = add_picture("/camera/rgb/image_raw");
    depth_info_ = file_->add(depth + "camera_info", ros::kCameraInfo, false);
    if (packed_depth()) {
      depth_ = file_->add(depth + "image_raw/compressedDepth", ros::kCompressedImage, false);
    } else {
      depth_ = file_->add(depth + (options_.depth == RosDepth::millimetres ? "image_raw" : "image"),
                          ros::kImage, false);
    }
  }

  void add_channel_topics() {
    const auto add = [&](bool wanted, const char* topic, const ros::MessageType& type,
                         bool latched = false) {
      return wanted ? file_->add(topic, type, latched) : 0;
    };
    const Channels& c = channels_;
    right_info_ = add(c.right, "/camera/right/camera_info", ros::kCameraInfo);
    if (c.right) right_ = add_picture("/camera/right/image_raw");
    events_ = add(c.events, "/camera/events", ros::kEventArray);
    imu_ = add(c.imu, "/imu", ros::kImu);
    true_depth_info_ = add(c.measured_depth, "/ground_truth/depth/camera_info", ros::kCameraInfo);
    true_depth_ = add(c.measured_depth, "/ground_truth/depth/image", ros::kImage);
    for (const ImageStream* stream : truth_)
      truth_topics_.push_back(
          file_->add("/ground_truth/" + stream->name + "/image", ros::kImage, false));
    legend_ = add(c.has_legend(), "/ground_truth/legend", ros::kString, true);
  }

  std::uint32_t add_picture(const std::string& topic) {
    return compressed() ? file_->add(topic + "/compressed", ros::kCompressedImage, false)
                        : file_->add(topic, ros::kImage, false);
  }

  static ros::Header header(const Frame& frame, const char* frame_id) {
    return {static_cast<std::uint32_t>(frame.index), frame.stamp_ns, frame_id};
  }

  void send(std::uint32_t topic, const Frame& frame, const std::string& message) {
    file_->write(topic, frame.stamp_ns, message);
  }

  template <typename T>
  void send_image(std::uint32_t topic, const Frame& frame, const char* encoding, int channels,
                  const std::vector<T>& values) {
    send(topic, frame,
         ros::image(version_, header(frame, kOptical), frame.intrinsics, encoding,
                    channels * static_cast<int>(sizeof(T)), values.data()));
  }

  void write_imu(const Frame& frame) {
    if (!channels_.imu) return;
    const ImuModel& model = options_.recording.imu;
    const auto variance = [&](double density) { return density * density * model.rate_hz; };
    for (const ImuSample& sample : frame.imu) {
      const ros::Header stamped{imu_count_++, sample.stamp_ns, kCamera};
      file_->write(imu_, sample.stamp_ns,
                   ros::imu(version_, stamped, sample, variance(model.gyroscope_noise),
                            variance(model.accelerometer_noise)));
    }
  }

  void write_clock_and_poses(const Frame& frame) {
    send(clock_, frame, ros::clock(version_, frame.stamp_ns));
    if (frame.index == 0) write_constants(frame);
    const ros::Header world = header(frame, kWorld);
    send(tf_, frame, ros::transforms(version_, world, {{kCamera, frame.world_from_camera}}));
    send(pose_, frame, ros::pose_stamped(version_, world, frame.world_from_camera));
  }

  void write_constants(const Frame& frame) {
    std::vector<ros::Transform> fixed{{kOptical, camera_from_optical}};
    if (channels_.right) {
      const Vec3 to_the_right{0, -frame.baseline, 0};
      fixed.push_back({kRightOptical, {camera_from_optical.rotation, to_the_right}});
    }
    send(tf_static_, frame, ros::transforms(version_, header(frame, kCamera), fixed));
    if (channels_.has_legend())
      send(legend_, frame, ros::string(version_, legend_to_json(options_.recording.legend)));
  }

  void write_camera(const Frame& frame, std::uint32_t info, std::uint32_t picture,
                    const char* frame_id, const std::vector<std::uint8_t>& rgb, double baseline) {
    const ros::Header optical = header(frame, frame_id);
    const Intrinsics& k = frame.intrinsics;
    send(info, frame, ros::camera_info(version_, optical, k, baseline));
    if (options_.pictures == RosPictures::raw) {
      send(picture, frame, ros::image(version_, optical, k, "rgb8", 3, rgb.data()));
      return;
    }
    const bool jpeg = options_.pictures == RosPictures::jpeg;
    const std::string bytes =
        jpeg ? encode_jpeg(k.width, k.height, rgb.data()) : encode_png(RgbImage{k.width, k.height, rgb});
    // "bgr8": what readers get from OpenCV's decoder, whose order is not the file's.
    send(picture, frame,
         ros::compressed_image(version_, optical,
                               jpeg ? "rgb8; jpeg compressed bgr8" : "rgb8; png compressed bgr8",
                               bytes));
  }

  void write_depth(const Frame& frame) {
    const ros::Header optical = header(frame, kOptical);
    const Intrinsics& k = frame.intrinsics;
    const std::vector<float>& depth = channels_.measured_depth ? frame.measured_depth : frame.depth;
    send(depth_info_, frame, ros::camera_info(version_, optical, k));
    if (options_.depth == RosDepth::metres) {
      send_image(depth_, frame, "32FC1", 1, depth);
      return;
    }
    auto millimetres = encode_depth(depth, 0.001);
    if (!packed_depth()) {
      send_image(depth_, frame, "16UC1", 1, millimetres);
      return;
    }
    const std::string png = encode_png(DepthImage{k.width, k.height, std::move(millimetres)});
    send(depth_, frame,
         ros::compressed_image(version_, optical, "16UC1; compressedDepth png",
                               std::string(kCompressedDepthHeader, '\0') + png));
  }

  void write_ground_truth(const Frame& frame) {
    const Channels& c = channels_;
    if (c.measured_depth) {
      send(true_depth_info_, frame,
           ros::camera_info(version_, header(frame, kOptical), frame.intrinsics));
      send_image(true_depth_, frame, "32FC1", 1, frame.depth);
    }
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      const ImageStream& stream = *truth_[i];
      std::visit(
          [&](const auto* values) {
            send_image(truth_topics_[i], frame, stream.ros_encoding(), stream.components, *values);
          },
          *find_image(frame, stream));
    }
  }

  std::unique_ptr<RosFile> file_;
  ros::Version version_;
  RosOptions options_;
  Channels channels_;
  StreamSet truth_;
  FrameOrder order_;
  std::uint32_t imu_count_ = 0;
  // Numbers of the topics.
  std::uint32_t clock_ = 0, tf_static_ = 0, tf_ = 0, pose_ = 0, rgb_info_ = 0, rgb_ = 0,
                depth_info_ = 0, depth_ = 0;
  std::uint32_t right_info_ = 0, right_ = 0, events_ = 0, imu_ = 0, true_depth_info_ = 0,
                true_depth_ = 0, legend_ = 0;
  std::vector<std::uint32_t> truth_topics_;  // of truth_
};

}  // namespace

std::unique_ptr<Recorder> make_ros_recorder(const std::string& path, std::unique_ptr<RosFile> file,
                                            const RosOptions& options) {
  return std::make_unique<RosRecorder>(path, std::move(file), options);
}

}  // namespace rubble
