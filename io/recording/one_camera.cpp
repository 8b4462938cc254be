#include "io/recording/one_camera.h"

namespace rubble {
namespace {

class OneCamera : public Recorder {
 public:
  OneCamera(int camera, std::unique_ptr<Recorder> recorder)
      : camera_(camera), recorder_(std::move(recorder)) {}

  void write(const Frame& frame) override {
    if (frame.sensor != camera_) return;
    Frame alone = frame;
    alone.sensor = 0;
    recorder_->write(alone);
  }
  void write_imu(const ImuSample& sample) override { recorder_->write_imu(sample); }
  void write_robot(const RobotSample& sample) override { recorder_->write_robot(sample); }
  void write_lidar(const LidarScan& scan) override { recorder_->write_lidar(scan); }
  void finish() override { recorder_->finish(); }

 private:
  int camera_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace

std::unique_ptr<Recorder> make_one_camera_recorder(int camera, std::unique_ptr<Recorder> recorder) {
  return std::make_unique<OneCamera>(camera, std::move(recorder));
}

}  // namespace rubble
