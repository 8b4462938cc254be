#include "io/recording/frame_order.h"

#include "kernel/base/error.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void check_size(const char* what, std::size_t found, std::size_t expected,
                const std::string& where) {
  if (found == expected) return;
  throw RunError(where + "the " + what + " picture has " + std::to_string(found) +
                 " values where the intrinsics ask for " + std::to_string(expected));
}

void check_pictures(const Frame& frame, const Channels& channels, const std::string& where) {
  const Intrinsics& k = frame.intrinsics;
  if (k.width <= 0 || k.height <= 0) throw RunError(where + "the picture has no pixels");
  const std::size_t pixels = static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
  check_size("colour", frame.rgb.size(), 3 * pixels, where);
  check_size("depth", frame.depth.size(), pixels, where);
  if (channels.right) check_size("right", frame.rgb_right.size(), 3 * pixels, where);
  if (channels.measured_depth)
    check_size("measured depth", frame.measured_depth.size(), pixels, where);
  for (const ImageStream* stream : channels.truth) {
    const auto image = find_image(frame, *stream);
    check_size(stream->name.c_str(), image ? count_values(*image) : 0,
               pixels * std::size_t(stream->components), where);
  }
}

}  // namespace

FrameOrder::FrameOrder(std::string recorder, const std::vector<Channels>& channels)
    : recorder_(std::move(recorder)) {
  for (const Channels& c : channels) cameras_.push_back({c});
}

// Frames of a sequence come at a steady rate, rounded to nanoseconds: one interval that is half as long again as
// another means that something is missing between.
void FrameOrder::check_stamp(const Frame& frame, Camera& camera, const std::string& where) {
  if (camera.count == 0) return;
  const std::int64_t interval = frame.stamp_ns - camera.last_stamp_ns;
  if (interval <= 0) {
    throw RunError(where + "its stamp of " + std::to_string(frame.stamp_ns) +
                   " ns is not later than the one before, " + std::to_string(camera.last_stamp_ns) +
                   " ns");
  }
  if (frame.starts_sequence) {
    camera.period_ns = 0;
    return;
  }
  if (camera.period_ns == 0) camera.period_ns = interval;
  if (2 * interval > 3 * camera.period_ns || 3 * interval < 2 * camera.period_ns) {
    throw RunError(where + "it comes " + std::to_string(interval) +
                   " ns after the one before, where " + std::to_string(camera.period_ns) +
                   " ns are usual: there is a gap in the stamps");
  }
}

void FrameOrder::check(const Frame& frame) {
  std::string where = recorder_ + ": frame " + std::to_string(frame.index) + ": ";
  if (frame.sensor < 0 || std::size_t(frame.sensor) >= cameras_.size())
    throw RunError(where + "camera " + std::to_string(frame.sensor) + " is not of this recording");
  if (cameras_.size() > 1)
    where = recorder_ + ": camera " + std::to_string(frame.sensor) + ", frame " +
            std::to_string(frame.index) + ": ";
  Camera& camera = cameras_[std::size_t(frame.sensor)];
  if (frame.index != camera.count)
    throw RunError(where + "frame " + std::to_string(camera.count) + " was expected");
  check_stamp(frame, camera, where);
  if (count_ > 0 && frame.stamp_ns < latest_ns_)
    throw RunError(where + "it is earlier than a frame of another camera that came before");
  check_pictures(frame, camera.channels, where);
  latest_ns_ = camera.last_stamp_ns = frame.stamp_ns;
  ++camera.count;
  ++count_;
}

std::vector<Channels> channels_of(const Recording& recording) {
  std::vector<Channels> channels;
  for (const CameraRecord& camera : recording.cameras) channels.push_back(camera.channels);
  return channels;
}

namespace {

class OneCamera : public Recorder {
 public:
  OneCamera(int camera, int imu, std::unique_ptr<Recorder> recorder)
      : camera_(camera), imu_(imu), recorder_(std::move(recorder)) {}

  void write(const Frame& frame) override {
    if (frame.sensor != camera_) return;
    Frame alone = frame;
    alone.sensor = 0;
    recorder_->write(alone);
  }
  void write_imu(const ImuSample& sample) override {
    if (sample.sensor != imu_) return;
    ImuSample alone = sample;
    alone.sensor = 0;
    recorder_->write_imu(alone);
  }
  void write_robot(const RobotSample& sample) override { recorder_->write_robot(sample); }
  void write_reading(const Reading& reading) override { recorder_->write_reading(reading); }
  void finish() override { recorder_->finish(); }

 private:
  int camera_, imu_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace

std::unique_ptr<Recorder> make_one_camera_recorder(int camera, int imu, std::unique_ptr<Recorder> recorder) {
  return std::make_unique<OneCamera>(camera, imu, std::move(recorder));
}

int find_imu_beside(const Recording& recording, std::size_t camera) {
  for (std::size_t i = 0; i < recording.imus.size(); ++i)
    if (recording.imus[i].carrier == recording.cameras.at(camera).carrier) return int(i);
  return -1;
}

}  // namespace rubble
