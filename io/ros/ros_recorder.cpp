#include "io/ros/ros_recorder.h"

#include <algorithm>

#include "io/image/image_file.h"
#include "io/ros/vector_colours.h"
#include "io/recording/frame_order.h"
#include "io/ros/robot_topics.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

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

// Numbers of a camera's topics.
struct CameraTopics {
  std::uint32_t rgb_info = 0, rgb = 0, depth_info = 0, depth = 0, right_info = 0, right = 0,
                events = 0, true_depth_info = 0, true_depth = 0, pose = 0;
  std::vector<std::uint32_t> truth;  // of the streams
};

class RosRecorder : public Recorder {
 public:
  RosRecorder(const std::string& path, std::unique_ptr<RosFile> file, const RosOptions& options)
      : file_(std::move(file)),
        version_(file_->version()),
        options_(options),
        recording_(options.recording),
        order_(path, channels_of(options.recording)),
        imu_counts_(options.recording.imus.size()),
        reading_counts_(options.recording.sensors.size()) {
    for (CameraRecord& camera : recording_.cameras)
      camera.channels.truth = floats_first(camera.channels.truth);
    add_topics();
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    tick(frame.stamp_ns);
    if (frame.stamp_ns != last_ns_) write_instant(frame);
    const CameraRecord& camera = recording_.cameras[std::size_t(frame.sensor)];
    write_rig(frame, camera);
    const CameraTopics& topics = cameras_[std::size_t(frame.sensor)];
    const Channels& c = camera.channels;
    write_camera(frame, topics.rgb_info, topics.rgb, camera.optical, frame.rgb, 0);
    if (c.right)
      write_camera(frame, topics.right_info, topics.right, camera.right_optical, frame.rgb_right,
                   frame.baseline);
    write_depth(frame, camera, topics);
    write_ground_truth(frame, camera, topics);
    if (c.events) {
      send(topics.events, frame,
           ros::event_array(version_, header(frame, camera.optical), frame.intrinsics,
                            frame.events));
    }
  }

  void write_imu(const ImuSample& sample) override {
    tick(sample.stamp_ns);
    const auto i = std::size_t(sample.sensor);
    const ImuRecord& imu = recording_.imus.at(i);
    const ImuModel& model = imu.model;
    const auto variance = [&](double density) { return density * density * model.rate_hz; };
    const ros::Header stamped{imu_counts_[i]++, sample.stamp_ns, imu.frame_id};
    file_->write(imus_[i], sample.stamp_ns,
                 ros::imu(version_, stamped, sample, variance(model.gyroscope_noise),
                          variance(model.accelerometer_noise)));
  }

  // After the descriptions and fixed transforms, which come with the first frame.
  void write_robot(const RobotSample& sample) override {
    tick(sample.stamp_ns);
    begin_without_cameras(sample.stamp_ns);
    if (instants_ > 0)
      robots_->write(sample, tf_);
    else
      early_.push_back(sample);
  }

  void write_reading(const Reading& reading) override {
    tick(reading.stamp_ns);
    const auto i = std::size_t(reading.sensor);
    const SensorRecord& sensor = recording_.sensors.at(i);
    const ros::Header stamped{reading_counts_[i]++, reading.stamp_ns, sensor.frame_id};
    for (std::size_t topic = 0; topic < sensors_[i].size(); ++topic)
      file_->write(sensors_[i][topic], reading.stamp_ns, sensor.format->message(topic, version_, stamped, reading));
  }

  void finish() override { file_->finish(); }

 private:
  bool compressed() const { return options_.pictures != RosPictures::raw; }
  bool has_colours(const ImageStream& stream) const { return options_.vector_colours && stream.components > 1 && std::holds_alternative<PixelMaker<float>>(stream.make); }
  bool packed_depth() const { return compressed() && options_.depth == RosDepth::millimetres; }

  // Other sensors stand among the topics of the first camera, before its ground truth.
  void add_topics() {
    clock_ = file_->add("/clock", ros::kClock, false);
    tf_static_ = file_->add("/tf_static", ros::kTfMessage, true);
    tf_ = file_->add("/tf", ros::kTfMessage, false);
    if (std::any_of(recording_.cameras.begin(), recording_.cameras.end(),
                    [](const CameraRecord& camera) { return camera.carrier.empty(); }))
      pose_ = file_->add("/ground_truth/pose", ros::kPoseStamped, false);
    for (const CameraRecord& camera : recording_.cameras) {
      CameraTopics& topics = cameras_.emplace_back();
      add_pictures(camera, topics);
      if (cameras_.size() == 1) add_other_sensors();
      add_ground_truth(camera, topics);
    }
    if (cameras_.empty()) add_other_sensors();
    robots_ = std::make_unique<RobotTopics>(recording_.robots, *file_);
    if (recording_.has_legend())
      legend_ = file_->add("/ground_truth/legend", ros::kString, true);
  }

  void add_other_sensors() {
    for (const ImuRecord& imu : recording_.imus)
      imus_.push_back(file_->add(imu.topic, ros::kImu, false));
    for (const SensorRecord& sensor : recording_.sensors) {
      std::vector<std::uint32_t>& topics = sensors_.emplace_back();
      for (const ReadingFormat::Topic& topic : sensor.format->topics())
        topics.push_back(file_->add(sensor.topic + topic.suffix, *topic.type, false));
    }
  }

  void add_pictures(const CameraRecord& camera, CameraTopics& topics) {
    const std::string depth = camera.topic + "/depth_registered/";
    topics.rgb_info = file_->add(camera.topic + "/rgb/camera_info", ros::kCameraInfo, false);
    topics.rgb = add_picture(camera.topic + "/rgb/image_raw");
    topics.depth_info = file_->add(depth + "camera_info", ros::kCameraInfo, false);
    if (packed_depth())
      topics.depth = file_->add(depth + "image_raw/compressedDepth", ros::kCompressedImage, false);
    else
      topics.depth = file_->add(
          depth + (options_.depth == RosDepth::millimetres ? "image_raw" : "image"), ros::kImage,
          false);
    const Channels& c = camera.channels;
    if (c.right) {
      topics.right_info = file_->add(camera.topic + "/right/camera_info", ros::kCameraInfo, false);
      topics.right = add_picture(camera.topic + "/right/image_raw");
    }
    if (c.events) topics.events = file_->add(camera.topic + "/events", ros::kEventArray, false);
  }

  void add_ground_truth(const CameraRecord& camera, CameraTopics& topics) {
    const std::string truth = camera.truth_topic + "/";
    if (!camera.carrier.empty()) topics.pose = file_->add(truth + "pose", ros::kPoseStamped, false);
    if (camera.channels.measured_depth) {
      topics.true_depth_info = file_->add(truth + "depth/camera_info", ros::kCameraInfo, false);
      topics.true_depth = file_->add(truth + "depth/image", ros::kImage, false);
    }
    for (const ImageStream* stream : camera.channels.truth)
      topics.truth.push_back(file_->add(truth + stream->name + (has_colours(*stream) ? "/colours/image" : "/image"), ros::kImage, false));
  }

  std::uint32_t add_picture(const std::string& topic) {
    return compressed() ? file_->add(topic + "/compressed", ros::kCompressedImage, false)
                        : file_->add(topic, ros::kImage, false);
  }

  static ros::Header header(const Frame& frame, const std::string& frame_id) {
    return {static_cast<std::uint32_t>(frame.index), frame.stamp_ns, frame_id};
  }

  void send(std::uint32_t topic, const Frame& frame, const std::string& message) {
    file_->write(topic, frame.stamp_ns, message);
  }

  template <typename T>
  void send_image(std::uint32_t topic, const Frame& frame, const std::string& frame_id,
                  const char* encoding, int channels, const std::vector<T>& values) {
    send(topic, frame,
         ros::image(version_, header(frame, frame_id), frame.intrinsics, encoding,
                    channels * static_cast<int>(sizeof(T)), values.data()));
  }

  // The clock has every stamp that a stream has.
  void tick(std::int64_t stamp_ns) {
    if (stamp_ns <= clock_ns_) return;  // live, a sensor may be late
    clock_ns_ = stamp_ns;
    file_->write(clock_, stamp_ns, ros::clock(version_, stamp_ns));
  }

  // What holds all the time comes with the first frame, else with the first sample of a robot.
  void begin_without_cameras(std::int64_t stamp_ns) {
    if (instants_ > 0 || !recording_.cameras.empty()) return;
    ++instants_;
    Frame frame;
    frame.stamp_ns = stamp_ns;
    write_constants(frame);
  }

  // Once for the frames of all cameras at one instant.
  void write_instant(const Frame& frame) {
    if (instants_++ == 0) write_constants(frame);
    last_ns_ = frame.stamp_ns;
    write_rig(frame, recording_.cameras[std::size_t(frame.sensor)]);
    for (const RobotSample& sample : early_) robots_->write(sample, tf_);
    early_.clear();
  }

  // By the first frame of a camera on it.
  void write_rig(const Frame& frame, const CameraRecord& camera) {
    if (!camera.carrier.empty() || frame.stamp_ns == rig_ns_) return;
    rig_ns_ = frame.stamp_ns;
    const ros::Header world{rigs_++, frame.stamp_ns, ros::kWorld};
    if (!recording_.mount)
      send(tf_, frame, ros::transforms(version_, world, {{recording_.rig, frame.world_from_rig}}));
    send(pose_, frame, ros::pose_stamped(version_, world, frame.world_from_rig));
  }

  void write_constants(const Frame& frame) {
    std::vector<ros::Transform> fixed;
    for (const CameraRecord& camera : recording_.cameras) add_transforms(camera, fixed);
    for (const ImuRecord& imu : recording_.imus)
      if (imu.frame_id != recording_.frame_of(imu.carrier))
        fixed.push_back({imu.frame_id, imu.rig_from_imu, recording_.frame_of(imu.carrier)});
    if (recording_.mount)
      fixed.push_back({recording_.rig, recording_.mount->parent_from_rig, recording_.mount->parent});
    robots_->add_transforms(fixed);
    for (const SensorRecord& sensor : recording_.sensors)
      fixed.push_back({sensor.frame_id, sensor.rig_from_sensor, recording_.frame_of(sensor.carrier)});
    send(tf_static_, frame,
         ros::transforms(version_, header(frame, recording_.rig), fixed));
    robots_->write_descriptions(frame.stamp_ns);
    if (recording_.has_legend())
      send(legend_, frame, ros::string(version_, legend_to_json(recording_.legend)));
  }

  // From the rig to the camera's body, unless that is the rig, and on to its pictures.
  void add_transforms(const CameraRecord& camera, std::vector<ros::Transform>& fixed) const {
    const std::string& carrier = recording_.frame_of(camera.carrier);
    if (camera.link != carrier) fixed.push_back({camera.link, camera.rig_from_camera, carrier});
    fixed.push_back({camera.optical, camera_from_optical, camera.link});
    if (!camera.channels.right) return;
    const Vec3 to_the_right{0, -camera.baseline, 0};
    fixed.push_back(
        {camera.right_optical, {camera_from_optical.rotation, to_the_right}, camera.link});
  }

  void write_camera(const Frame& frame, std::uint32_t info, std::uint32_t picture,
                    const std::string& frame_id, const std::vector<std::uint8_t>& rgb,
                    double baseline) {
    const ros::Header optical = header(frame, frame_id);
    const Intrinsics& k = frame.intrinsics;
    send(info, frame, ros::camera_info(version_, optical, k, baseline));
    if (options_.pictures == RosPictures::raw) {
      send(picture, frame, ros::image(version_, optical, k, "rgb8", 3, rgb.data()));
      return;
    }
    const bool jpeg = options_.pictures == RosPictures::jpeg;
    const std::string bytes = jpeg ? encode_jpeg(k.width, k.height, rgb.data())
                                   : encode_png(RgbImage{k.width, k.height, rgb});
    // "bgr8": what readers get from OpenCV's decoder, whose order is not the file's.
    send(picture, frame,
         ros::compressed_image(version_, optical,
                               jpeg ? "rgb8; jpeg compressed bgr8" : "rgb8; png compressed bgr8",
                               bytes));
  }

  void write_depth(const Frame& frame, const CameraRecord& camera, const CameraTopics& topics) {
    const ros::Header optical = header(frame, camera.optical);
    const Intrinsics& k = frame.intrinsics;
    const std::vector<float>& depth =
        camera.channels.measured_depth ? frame.measured_depth : frame.depth;
    send(topics.depth_info, frame, ros::camera_info(version_, optical, k));
    if (options_.depth == RosDepth::metres) {
      send_image(topics.depth, frame, camera.optical, "32FC1", 1, depth);
      return;
    }
    auto millimetres = encode_depth(depth, 0.001);
    if (!packed_depth()) {
      send_image(topics.depth, frame, camera.optical, "16UC1", 1, millimetres);
      return;
    }
    const std::string png = encode_png(DepthImage{k.width, k.height, std::move(millimetres)});
    send(topics.depth, frame,
         ros::compressed_image(version_, optical, "16UC1; compressedDepth png",
                               std::string(kCompressedDepthHeader, '\0') + png));
  }

  void write_ground_truth(const Frame& frame, const CameraRecord& camera,
                          const CameraTopics& topics) {
    if (!camera.carrier.empty())
      send(topics.pose, frame, ros::pose_stamped(version_, header(frame, ros::kWorld), frame.world_from_camera));
    if (camera.channels.measured_depth) {
      send(topics.true_depth_info, frame,
           ros::camera_info(version_, header(frame, camera.optical), frame.intrinsics));
      send_image(topics.true_depth, frame, camera.optical, "32FC1", 1, frame.depth);
    }
    const StreamSet& streams = camera.channels.truth;
    for (std::size_t i = 0; i < streams.size(); ++i) {
      const ImageStream& stream = *streams[i];
      if (has_colours(stream)) {
        const auto& values = *std::get<const std::vector<float>*>(*find_image(frame, stream));
        send_image(topics.truth[i], frame, camera.optical, "rgb8", 3, colour_vectors(stream, values, frame.intrinsics.width));
        continue;
      }
      std::visit(
          [&](const auto* values) {
            send_image(topics.truth[i], frame, camera.optical, stream.ros_encoding(),
                       stream.components, *values);
          },
          *find_image(frame, stream));
    }
  }

  std::unique_ptr<RosFile> file_;
  ros::Version version_;
  RosOptions options_;
  Recording recording_;
  FrameOrder order_;
  std::uint32_t instants_ = 0, rigs_ = 0;
  std::int64_t rig_ns_ = -1;               // of the last pose of the rig
  std::int64_t last_ns_ = -1;              // of the last instant
  std::int64_t clock_ns_ = -1;             // of the last tick, which is the latest
  std::vector<std::uint32_t> imu_counts_;   // readings of each unit
  std::vector<std::uint32_t> reading_counts_;  // of each other sensor
  // Numbers of the topics.
  std::uint32_t clock_ = 0, tf_static_ = 0, tf_ = 0, pose_ = 0, legend_ = 0;
  std::vector<CameraTopics> cameras_;
  std::vector<std::uint32_t> imus_;
  std::vector<std::vector<std::uint32_t>> sensors_;
  std::unique_ptr<RobotTopics> robots_;
  std::vector<RobotSample> early_;  // that came before the first frame
};

}  // namespace

std::unique_ptr<Recorder> make_ros_recorder(const std::string& path, std::unique_ptr<RosFile> file,
                                            const RosOptions& options) {
  return std::make_unique<RosRecorder>(path, std::move(file), options);
}

}  // namespace rubble
