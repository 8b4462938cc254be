#include "app/drive/drive_link.h"

#include <cmath>

#include "app/pipeline/live.h"
#include "io/live/live_ros.h"

namespace rubble {
std::unique_ptr<DriveLink> DriveLink::connect(const RunOptions& options) {
  std::unique_ptr<DriveStream> stream = make_drive_stream(options);
  if (!stream) return nullptr;
  return std::unique_ptr<DriveLink>(new DriveLink(std::move(stream)));
}

DriveLink::DriveLink(std::unique_ptr<DriveStream> stream) : stream_(std::move(stream)) {}
DriveLink::~DriveLink() = default;

void DriveLink::enter(const DriveWorld& world) {
  Recording recording = describe_recording(world.scenario, world.assets, world.pile,
                                           world.robots ? world.robots->records() : std::vector<RobotRecord>());
  if (world.robots) recording.mount = world.robots->mount();
  recorder_ = make_ros_recorder("the live stream", keep_stream(*stream_, topics_),
                                ros_options(world.scenario.outputs, recording));
  start_ns_ = world.scenario.start_ns;
  rate_hz_ = world.scenario.trajectory.rate_hz;
  of_this_world_ = 0;
}

void DriveLink::add_to(DriveInput& input, double seconds) {
  controls_.hear(stream_->take(), seconds);
  controls_.add_to(input);
}

// Stamps as DriveLog::stamp_ns().
void DriveLink::publish(const Frame& frame, const std::vector<Sample>& sensed) {
  Frame sent = frame;
  sent.index = of_this_world_++;
  sent.stamp_ns =
      start_ns_ + std::int64_t(std::floor(double(published_++) * 1e9 / rate_hz_ + 0.5));
  shift_ns_ = sent.stamp_ns - frame.stamp_ns;
  publish(sensed);
  recorder_->write(sent);
}

void DriveLink::publish(std::vector<Sample> sensed) {
  for (Sample& sample : sensed) {
    std::visit([&](auto& of) { of.stamp_ns += shift_ns_; }, sample);
    write_sample(*recorder_, sample);
  }
}

void DriveLink::finish() { stream_->finish(); }

}  // namespace rubble
