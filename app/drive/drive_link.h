// What a drive has with a network, where it was asked to: frames go out, commands come in
// (docs/how_to/live.md).
#pragma once

#include <map>
#include <memory>
#include <string>

#include "app/drive/drive_world.h"
#include "app/drive/remote_controls.h"
#include "io/recording/recorder.h"

namespace rubble {

class DriveStream;

class DriveLink {
 public:
  // None when the options ask for none. After check_live().
  static std::unique_ptr<DriveLink> connect(const RunOptions& options);
  ~DriveLink();

  // From now on frames are of that world; to be called before the first.
  void enter(const DriveWorld& world);
  // Adds what programs ask for in this step, of so many seconds.
  void add_to(DriveInput& input, double seconds);
  // Every leg begins at the mission's first stamp; what goes out goes on in time over all legs, so
  // that nobody's clock jumps back. Only the stamps of later legs differ from their recordings.
  // sensed: by robots since the frame before.
  void publish(const Frame& frame, const std::vector<Sample>& sensed);
  // What robots sensed in a step between two frames.
  void publish(std::vector<Sample> sensed);
  void finish();

 private:
  explicit DriveLink(std::unique_ptr<DriveStream> stream);

  std::unique_ptr<DriveStream> stream_;
  std::map<std::string, std::uint32_t> topics_;  // of the stream, kept over all worlds
  std::unique_ptr<Recorder> recorder_;
  RemoteControls controls_;
  std::int64_t start_ns_ = 0;
  double rate_hz_ = 0;
  int published_ = 0, of_this_world_ = 0;
  std::int64_t shift_ns_ = 0;  // from stamps of this leg to those that go out
};

}  // namespace rubble
