// How large a flight's recordings get at most, from the scenario alone; nothing is counted as
// compressed.
#pragma once

#include "render/streams/image_streams.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

constexpr double kFrameOverhead = 4096;  // poses, headers and indices of a frame; unit: byte
constexpr double kEventsPerPixel = 0.5;  // of an event camera, in a frame
constexpr double kPictureOverhead = 2048;  // of a file and its line in a list; unit: byte

// What is recorded of a flight: counts.
struct FlightSize {
  // At most; a mean where the pile decides. points: of the scans, with all their returns.
  double frames = 0, key_frames = 0, imu_samples = 0, scans = 0, points = 0, readings = 0;
  double robot_samples = 0;  // of all robots: what their joints and wheels say
};
// Of one of its cameras; other sensors are counted with the first.
FlightSize size_of_flight(const Scenario& scenario, std::size_t camera);

// Bytes of a frame's pixels in each kind of recording, apart from what is kept once.
class PictureSize {
 public:
  PictureSize(const MountedCamera& c, DepthEncoding ros_depth)
      : pixels_(double(c.camera.width) * c.camera.height),
        channels_(c.camera.channel_set()),
        right_(c.camera.stereo_baseline > 0),
        measured_(c.depth_sensor.type != DepthSensorType::none),
        events_(c.event_camera.on ? kEventsPerPixel * pixels_ : 0),
        ros_depth_(ros_depth == DepthEncoding::metres ? 4 : 2) {}

  double colours() const { return pixels_ * (right_ ? 6 : 3); }
  double rawlog() const { return colours() + pixels_ * (measured_ ? 4 : 2); }
  double ros() const {
    const double depth = ros_depth_ + (measured_ ? 4 : 0);
    return colours() + pixels_ * (depth + ground_truth()) + 13 * events_;
  }
  double tum() const { return pixels_ * (3 + (measured_ ? 4 : 2)); }
  double euroc() const { return colours() / 3; }
  // Left pictures and depth; of every sixteenth pixel a point.
  double nerfstudio() const { return pixels_ * (3 + 2 + 15.0 / 16); }
  // The masks of pieces share the pixels: a run in each column of eight pixels is a bad case.
  double coco() const { return pixels_ * (3 + 1); }
  double frames() const {
    return colours() + pixels_ * ((measured_ ? 8 : 4) + ground_truth()) + 25 * events_;
  }
  // How many files a frame is in a folder with all channels.
  static int most_files() { return int(image_streams().size()); }

 private:
  double ground_truth() const {
    double bytes = 0;
    for (const ImageStream* stream : channels_) bytes += double(stream->bytes_per_pixel());
    return bytes;
  }

  double pixels_;
  StreamSet channels_;
  bool right_, measured_;
  double events_;
  int ros_depth_;
};

// All that the size of a recording of one camera depends on.
struct RecordedSize {
  MountedCamera camera;      // of the mission
  FlightSize flight;         // its counts
  PictureSize picture;       // its pixels, in bytes
  double legend = 0;         // of what piece and label numbers mean; unit: byte

  // per_frame, per_imu_sample, once; unit: byte
  double of(double per_frame, double per_imu_sample, double once = 0) const {
    return flight.frames * per_frame + flight.imu_samples * per_imu_sample + once;
  }
};
// At most, of scans; unit: byte.
inline double size_of_scans(const FlightSize& flight, double per_scan, double per_point) {
  return flight.scans * per_scan + flight.points * per_point;
}

// Of each camera. pieces: of the pile.
std::vector<RecordedSize> sizes_of_recording(const Scenario& scenario, double pieces);

}  // namespace rubble
