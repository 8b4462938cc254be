// What the tests of io share: frames with known answers, folders that vanish, and other programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble::test {

// A folder of its own under the system's temporary one, removed with all its content.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::vector<std::string> names() const;  // of the files in it, sorted

 private:
  std::string path_;
};

// The scene of make_frame: the ground z = 0 and a sphere on it; nothing above the horizon.
inline constexpr Vec3 kSphereCentre{4.0, 0.3, 0.8};
inline constexpr double kSphereRadius = 0.8;

// Distance of a world point from the nearest surface of that scene; unit: m.
double distance_to_scene(const Vec3& point);

// Frame `index` of a camera that moves and turns a little; depth by closed form, planar, NaN above
// the horizon. Every pixel's colour tells its column, row and index.
Frame make_frame(int index, int width = 96, int height = 64);

// make_frame with every optional channel filled, and the recording that asks for them.
Frame make_full_frame(int index, int width = 96, int height = 64);
Recording full_recording();
// The readings of an inertial unit that come with it, up to and with its stamp, and both in order.
std::vector<ImuSample> make_full_imu(int index);
void write_full(Recorder& recorder, int index);

// make_frame with as much fine detail in colour and depth as a rendered one, for timing.
Frame make_busy_frame(int index, int size);

struct CommandResult {
  int exit_code = -1;
  std::string output;  // both stdout and stderr
};
// Runs a shell command and waits for it.
CommandResult run_command(const std::string& command);

// Runs a script of tests/io/node with the npm packages of package-lock.json, which are installed
// first, into the build folder, when they are not; the network is needed only then.
CommandResult run_node(const std::string& script, const std::string& arguments);

// One observation, whatever the reading.
class FixedObservation : public ReadingFormat {
 public:
  explicit FixedObservation(RawlogObservation observation) : observation_(std::move(observation)) {}
  std::vector<ReadingColumn> columns() const override { return {}; }
  std::vector<Topic> topics() const override { return {}; }
  std::string message(std::size_t, ros::Version, const ros::Header&, const Reading&) const override { return ""; }
  RawlogObservation observe(const Reading&) const override { return observation_; }

 private:
  RawlogObservation observation_;
};

// Of a sensor that scans in this way.
class FixedScans : public FixedObservation {
 public:
  explicit FixedScans(LidarSpec spec) : FixedObservation({}), spec_(std::make_shared<const LidarSpec>(std::move(spec))) {}
  double most_points() const override { return spec_->rays(); }
  std::shared_ptr<const LidarSpec> scan_spec() const override { return spec_; }

 private:
  std::shared_ptr<const LidarSpec> spec_;
};

std::string read_text(const std::string& path);  // empty when there is none
bool exists(const std::string& path);

}  // namespace rubble::test
