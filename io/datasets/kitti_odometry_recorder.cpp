#include <algorithm>
#include <memory>

#include "io/base/folder_writer.h"
#include "io/base/little_endian.h"
#include "io/datasets/dataset_recorders.h"
#include "io/datasets/pose_rows.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

const std::string kSequence = "sequences/00/";
constexpr int kKittiDigits = 9;  // after the point

template <typename Numbers>
std::string kitti_line(const Numbers& numbers) {
  std::string line;
  for (const double v : numbers) line += (line.empty() ? "" : " ") + fixed_text(v, kKittiDigits);
  return line + "\n";
}

// A projection of the rectified left camera to one that is `right` metres beside it.
std::array<double, 12> projection_of(const Intrinsics& k, double right) {
  return {k.fx, 0, k.cx, right == 0 ? 0 : -k.fx * right, 0, k.fy, k.cy, 0, 0, 0, 1, 0};
}

// Where the sensor was at a time of its scan; the list has its pose every kMotionStep.
Pose scanner_at(const RangeScan& scan, std::int64_t since_ns) {
  const std::vector<Pose>& poses = scan.world_from_sensor;
  const std::int64_t step = RangeScan::kMotionStep;
  const auto last = std::int64_t(poses.size()) - 1;
  const std::int64_t i = std::clamp<std::int64_t>(since_ns / step, 0, std::max<std::int64_t>(last - 1, 0));
  if (last < 1) return poses.front();
  const double share = std::clamp(double(since_ns - i * step) / double(step), 0.0, 1.0);
  const Pose &a = poses[std::size_t(i)], &b = poses[std::size_t(i) + 1];
  return {portable::slerp(a.rotation, b.rotation, share), a.translation + (b.translation - a.translation) * share};
}

// The echoes in the frame of the sensor at one time, as if it had not moved.
std::string still_scan(const RangeScan& scan, std::int64_t stamp_ns) {
  const Pose from_world = scanner_at(scan, stamp_ns - scan.stamp_ns).inverse();
  std::string bytes;
  bytes.reserve(16 * scan.points.size());
  for (const ScanPoint& p : scan.points) {
    const auto since_ns = std::int64_t(double(p.time) * 1e9 + 0.5);
    const Vec3 still = from_world * (scanner_at(scan, since_ns) * Vec3{p.x, p.y, p.z});
    for (const double value : {still.x, still.y, still.z}) put(bytes, float(value));
    put(bytes, p.intensity / 100);
  }
  return bytes;
}

class KittiOdometryRecorder : public Recorder {
 public:
  KittiOdometryRecorder(const std::string& path, const Recording& recording, int threads)
      : scanner_(scanner_of(recording)),
        channels_(channels_for(recording)),
        order_(path, channels_),
        folder_(path, folders(), threads),
        path_(path) {}

  void write_reading(const Reading& reading) override {
    if (reading.sensor != scanner_) return;
    scan_ = reading.scan;
    scan_is_new_ = true;
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    if (scanner_ >= 0 && !covers(frame)) {
      missing_ = missing_ < 0 ? frame.index : missing_;
      return;
    }
    if (missing_ >= 0)
      throw RunError(path_ + ": no scan of the LiDAR covers the stamp of picture " + std::to_string(missing_));
    scan_is_new_ = false;
    const std::string name = "/" + index_text(count_++);
    add_pictures(frame, name);
    const Pose world_from_optical = frame.world_from_camera * camera_from_optical;
    if (count_ == 1) begin(frame, world_from_optical);
    times_ += seconds_text(frame.stamp_ns - first_ns_) + "\n";
    poses_ += kitti_line(pose_rows(first_from_world_ * world_from_optical));
    if (scanner_ < 0) return;
    folder_.add(kSequence + "velodyne" + name + ".bin",
                [scan = scan_, stamp = frame.stamp_ns] { return still_scan(*scan, stamp); });
  }

  void finish() override {
    folder_.write(kSequence + "calib.txt", calibration_);
    folder_.write(kSequence + "times.txt", times_);
    folder_.write("poses/00.txt", poses_);
    folder_.finish();
  }

 private:
  static int scanner_of(const Recording& recording) {
    for (std::size_t i = 0; i < recording.sensors.size(); ++i) {
      const auto spec = recording.sensors[i].format->scan_spec();
      if (spec && !spec->planar()) return int(i);
    }
    return -1;
  }

  static Channels channels_for(const Recording& recording) {
    Channels channels;  // what the format has a place for
    channels.right = recording.cameras.front().channels.right;
    return channels;
  }

  std::vector<std::string> folders() const {
    std::vector<std::string> names{"poses", kSequence + "image_0", kSequence + "image_2"};
    if (channels_.right) names.insert(names.end(), {kSequence + "image_1", kSequence + "image_3"});
    if (scanner_ >= 0) names.push_back(kSequence + "velodyne");
    return names;
  }

  // The scan that began last has to reach over the stamp, and belongs to one picture.
  bool covers(const Frame& frame) const {
    if (!scan_is_new_) return false;
    const std::int64_t since = frame.stamp_ns - scan_->stamp_ns;
    return since >= 0 && since <= std::int64_t(scan_->world_from_sensor.size()) * RangeScan::kMotionStep;
  }

  void add_pictures(const Frame& frame, const std::string& name) {
    add_pair("image_0", "image_2", name, frame, frame.rgb);
    if (channels_.right) add_pair("image_1", "image_3", name, frame, frame.rgb_right);
  }

  void add_pair(const char* grey, const char* colour, const std::string& name, const Frame& frame,
                const std::vector<std::uint8_t>& rgb) {
    const RgbImage image{frame.intrinsics.width, frame.intrinsics.height, rgb};
    folder_.add(kSequence + grey + name + ".png", [image] { return encode_png(to_gray(image)); });
    folder_.add(kSequence + colour + name + ".png", [image] { return encode_png(image); });
  }

  void begin(const Frame& frame, const Pose& world_from_optical) {
    first_ns_ = frame.stamp_ns;
    first_from_world_ = world_from_optical.inverse();
    for (int i = 0; i < 4; ++i)
      calibration_ += "P" + std::to_string(i) + ": " +
                      kitti_line(projection_of(frame.intrinsics, i % 2 == 1 && channels_.right ? frame.baseline : 0));
    const Pose optical_from_scanner =
        scanner_ < 0 ? camera_from_optical.inverse()
                     : first_from_world_ * scanner_at(*scan_, frame.stamp_ns - scan_->stamp_ns);
    calibration_ += "Tr: " + kitti_line(pose_rows(optical_from_scanner));
  }

  int scanner_;  // number of the sensor that scans; -1: none
  Channels channels_;
  FrameOrder order_;
  FolderWriter folder_;
  std::string path_;  // for messages
  std::shared_ptr<const RangeScan> scan_;  // the last one
  bool scan_is_new_ = false;       // since the last picture
  int count_ = 0;                  // pictures so far
  int missing_ = -1;               // index of the first picture without a scan
  std::int64_t first_ns_ = 0;
  Pose first_from_world_;
  std::string calibration_, times_, poses_;  // the files, so far
};

}  // namespace

std::unique_ptr<Recorder> make_kitti_odometry_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<KittiOdometryRecorder>(path, recording, threads);
}

}  // namespace rubble
