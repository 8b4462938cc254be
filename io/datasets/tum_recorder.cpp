#include "io/datasets/tum_recorder.h"

#include "io/base/atomic_file.h"
#include "io/base/folder_writer.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

constexpr double kDepthUnit = 1.0 / 5000;  // unit: m
constexpr char kTrajectoryHeader[] =
    "# ground truth trajectory of the optical frame\n"
    "# timestamp tx ty tz qx qy qz qw\n";

std::string trajectory_line(const Frame& frame) {
  const Pose pose = frame.world_from_camera * camera_from_optical;
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  std::string line = seconds_text(frame.stamp_ns);
  for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) line += " " + fixed_text(value, 9);
  return line + "\n";
}

class TumTrajectoryRecorder : public Recorder {
 public:
  explicit TumTrajectoryRecorder(const std::string& path) : file_(path), order_(path) {
    file_.write(kTrajectoryHeader);
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    file_.write(trajectory_line(frame));
  }

  void finish() override { file_.commit(); }

 private:
  AtomicFile file_;
  FrameOrder order_;
};

class TumRecorder : public Recorder {
 public:
  TumRecorder(const std::string& path, const Channels& channels, int threads)
      : channels_(channels),
        order_(path, channels),
        folder_(path, folders(channels), threads),
        colour_("# color images\n# timestamp filename\n"),
        depth_("# depth maps, 5000 = 1 m\n# timestamp filename\n"),
        trajectory_(kTrajectoryHeader) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.index == 0) write_calibration(frame.intrinsics);
    const Intrinsics& k = frame.intrinsics;
    const std::string stamp = seconds_text(frame.stamp_ns), name = sorted_seconds_text(frame.stamp_ns) + ".png";
    folder_.add("rgb/" + name,
                [image = RgbImage{k.width, k.height, frame.rgb}] { return encode_png(image); });
    add_depth("depth/" + name, frame,
              channels_.measured_depth ? frame.measured_depth : frame.depth);
    if (channels_.measured_depth) add_depth("depth_true/" + name, frame, frame.depth);
    const std::string colour_row = stamp + " rgb/" + name, depth_row = stamp + " depth/" + name;
    colour_ += colour_row + "\n";
    depth_ += depth_row + "\n";
    associations_ += colour_row + " " + depth_row + "\n";
    trajectory_ += trajectory_line(frame);
  }

  void finish() override {
    folder_.write("rgb.txt", colour_);
    folder_.write("depth.txt", depth_);
    folder_.write("associations.txt", associations_);
    folder_.write("groundtruth.txt", trajectory_);
    folder_.finish();
  }

 private:
  static std::vector<std::string> folders(const Channels& channels) {
    if (channels.measured_depth) return {"rgb", "depth", "depth_true"};
    return {"rgb", "depth"};
  }

  void add_depth(const std::string& name, const Frame& frame, const std::vector<float>& depth) {
    const int width = frame.intrinsics.width, height = frame.intrinsics.height;
    folder_.add(name, [image = DepthImage{width, height, encode_depth(depth, kDepthUnit)}] {
      return encode_png(image);
    });
  }

  void write_calibration(const Intrinsics& k) {
    std::string text = "# fx fy cx cy d0 d1 d2 d3 d4\n";
    for (const double value : {k.fx, k.fy, k.cx, k.cy}) text += exact_text(value) + " ";
    for (std::size_t i = 0; i < k.distortion.size(); ++i)
      text += exact_text(k.distortion[i]) + (i + 1 < k.distortion.size() ? " " : "\n");
    folder_.write("calibration.txt", text);
  }

  Channels channels_;
  FrameOrder order_;
  FolderWriter folder_;
  std::string colour_, depth_, associations_, trajectory_;  // the lists, so far
};

}  // namespace

std::unique_ptr<Recorder> make_tum_trajectory_recorder(const std::string& path) {
  return std::make_unique<TumTrajectoryRecorder>(path);
}

std::unique_ptr<Recorder> make_tum_recorder(const std::string& path, const Recording& recording,
                                            int threads) {
  Channels channels;  // what the format has a place for
  channels.measured_depth = recording.cameras.front().channels.measured_depth;
  return std::make_unique<TumRecorder>(path, channels, threads);
}

}  // namespace rubble
