// The tables of a recorded dataset, read back: what `frames`, `pcd` and `sensors` hold beside pictures.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/recording/recording.h"
#include "render/scene/sample.h"

namespace rubble {

// Lines of numbers, with the number of each line for errors.
struct NumberTable {
  std::string path;
  std::vector<std::vector<double>> rows;
  std::vector<std::vector<std::string>> words;  // of the same rows, as they are written
  std::vector<std::size_t> lines;               // from 1
};
// separator: between words. A first line that begins with a letter or # is a header. Every row has `columns` words, each
// a number but for those of `text_column` (-1: none). Throws InputError with file, line, what was expected and found.
NumberTable read_number_table(const std::string& path, char separator, std::size_t columns, int text_column = -1);

// Frames of poses.csv without their pictures, in their order: index, stamp, pose and velocity of the camera.
std::vector<Frame> read_frame_poses(const std::string& path);
// imu.csv; sensor: the number that the samples get.
std::vector<ImuSample> read_imu_table(const std::string& path, int sensor);
// events.txt.
std::vector<Event> read_event_table(const std::string& path);
// groundtruth.txt: poses by stamp; unit: ns.
std::map<std::int64_t, Pose> read_tum_poses(const std::string& path);
// sensors/NAME.csv.
std::vector<Reading> read_reading_table(const std::string& path, std::size_t columns, int sensor);

// The scans of a sensor: the folder pcd/NAME.
class RecordedScans {
 public:
  // sensor: its format states where the rays go. Throws InputError: a list is missing or damaged.
  RecordedScans(const std::string& folder, const SensorRecord& sensor);
  const std::vector<std::int64_t>& stamps_ns() const { return stamps_ns_; }
  // Throws InputError: the file is missing, damaged, or was not written by Rubble.
  std::shared_ptr<const RangeScan> read(std::size_t index) const;

 private:
  Pose pose_at(std::int64_t stamp_ns) const;

  std::string folder_;
  std::shared_ptr<const LidarSpec> spec_;  // never null
  std::vector<std::int64_t> stamps_ns_, motion_ns_;
  std::vector<std::string> files_;
  std::vector<Pose> motion_;  // of the sensor in the world, by motion_ns_
};

}  // namespace rubble
