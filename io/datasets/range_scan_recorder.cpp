#include "io/datasets/range_scan_recorder.h"

#include <map>

#include "io/base/folder_writer.h"
#include "io/base/little_endian.h"
#include "io/datasets/pose_rows.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::string make_pcd(const std::vector<ScanPoint>& points) {
  const std::string count = std::to_string(points.size());
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
                      "FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n"
                      "COUNT 1 1 1 1 1 1\nWIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                      count + "\nDATA binary\n";
  for (const ScanPoint& p : points) {
    for (const float value : {p.x, p.y, p.z, p.intensity}) put(bytes, value);
    put(bytes, p.ring);
    put(bytes, p.time);
  }
  return bytes;
}

std::string make_kitti(const std::vector<ScanPoint>& points) {
  std::string bytes;
  for (const ScanPoint& p : points)
    for (const float value : {p.x, p.y, p.z, p.intensity / 100}) put(bytes, value);
  return bytes;
}

// last_ns: of the last line; the lists of neighbouring scans overlap.
std::string motion_lines(const RangeScan& scan, std::int64_t& last_ns) {
  std::string lines;
  for (std::size_t i = 0; i < scan.world_from_sensor.size(); ++i) {
    const std::int64_t stamp_ns = scan.stamp_ns + std::int64_t(i) * RangeScan::kMotionStep;
    if (stamp_ns <= last_ns) continue;
    last_ns = stamp_ns;
    const auto& [q, t] = scan.world_from_sensor[i];
    lines += seconds_text(stamp_ns);
    for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) lines += " " + fixed_text(value, 9);
    lines += "\n";
  }
  return lines;
}

std::string kitti_pose(const Pose& pose) {
  std::string line;
  for (const double v : pose_rows(pose)) line += (line.empty() ? "" : " ") + fixed_text(v, 9);
  return line + "\n";
}

enum class Format { pcd, kitti };

std::vector<std::string> folders_of(Format format, const Recording& recording) {
  std::vector<std::string> folders;
  for (const SensorRecord& sensor : recording.sensors) {
    if (!sensor.scans()) continue;
    folders.push_back(sensor.name);
    if (format == Format::kitti) folders.push_back(sensor.name + "/velodyne");
  }
  return folders;
}

class RangeScanRecorder : public Recorder {
 public:
  RangeScanRecorder(const std::string& path, Format format, const Recording& recording, int threads)
      : format_(format), folder_(path, folders_of(format, recording), threads) {
    for (std::size_t i = 0; i < recording.sensors.size(); ++i)
      if (recording.sensors[i].scans()) lists_[int(i)].name = recording.sensors[i].name;
  }

  void write(const Frame&) override {}
  void write_reading(const Reading& reading) override {
    if (!reading.scan) return;
    const RangeScan& scan = *reading.scan;
    Lists& lists = lists_.at(reading.sensor);
    const std::string number = index_text(lists.scans);
    if (lists.scans++ == 0) lists.first_ns = scan.stamp_ns;
    const bool pcd = format_ == Format::pcd;
    folder_.add(lists.name + (pcd ? "/" + number + ".pcd" : "/velodyne/" + number + ".bin"),
                [points = scan.points, pcd] { return pcd ? make_pcd(points) : make_kitti(points); });
    lists.stamps += pcd ? seconds_text(scan.stamp_ns) + " " + number + ".pcd\n"
                        : seconds_text(scan.stamp_ns - lists.first_ns) + "\n";
    lists.poses += pcd ? motion_lines(scan, lists.motion_ns) : kitti_pose(scan.world_from_sensor.front());
  }

  void finish() override {
    for (const auto& [sensor, lists] : lists_) {
      const bool pcd = format_ == Format::pcd;
      folder_.write(lists.name + (pcd ? "/stamps.txt" : "/times.txt"), lists.stamps);
      folder_.write(lists.name + (pcd ? "/motion.txt" : "/poses.txt"), lists.poses);
    }
    folder_.finish();
  }

 private:
  struct Lists {  // of one sensor
    std::string name;
    int scans = 0;
    std::int64_t first_ns = 0, motion_ns = -1;
    std::string stamps{}, poses{};
  };

  Format format_;
  FolderWriter folder_;
  std::map<int, Lists> lists_;  // by sensor
};

}  // namespace

std::unique_ptr<Recorder> make_pcd_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<RangeScanRecorder>(path, Format::pcd, recording, threads);
}

std::unique_ptr<Recorder> make_kitti_recorder(const std::string& path, const Recording& recording,
                                              int threads) {
  return std::make_unique<RangeScanRecorder>(path, Format::kitti, recording, threads);
}

}  // namespace rubble
