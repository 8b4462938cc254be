#include "io/recording/one_camera.h"

namespace rubble {
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
