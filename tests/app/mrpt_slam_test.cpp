// Rawlogs of driven robots in MRPT's own SLAM programs: each must follow the robot (docs/how_to/mrpt_slam.md).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace mrpt_slam_test {

struct Place {
  double x = 0, y = 0;
};
double distance(const Place& a, const Place& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// The numbers of the last line of a text that has at least `count` of them after a first word; NaN where there is none.
std::vector<double> last_numbers(const std::string& text, const std::string& first_word, std::size_t count) {
  std::istringstream lines(text);
  std::vector<double> last(count, std::nan(""));
  std::string line;
  while (std::getline(lines, line)) {
    if (line.rfind(first_word, 0) != 0) continue;
    std::istringstream words(line.substr(first_word.size()));
    std::vector<std::string> found{std::istream_iterator<std::string>(words), {}};
    if (found.size() < count) continue;
    for (std::size_t i = 0; i < count; ++i) last[i] = std::strtod(found[i].c_str(), nullptr);
  }
  return last;
}

class MrptSlam : public ::testing::Test {
 protected:
  // Records the mission with that format of rawlog. more: arguments.
  void record(const std::string& format, const std::string& more) {
    const Outcome run = run_rubble("run scripts/robots/slam.lua --quiet --force --out " + (folder_ / "run") +
                                   " --set outputs.rawlog_format=" + format + " " + more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    keep_sensors("");
    const std::vector<double> first = numbers_of_truth(true), last = numbers_of_truth(false);
    truth_ = {last[1] - first[1], last[2] - first[2]};
    const std::string table = read_file(folder_ / "run/robots/tank_odometry.csv");
    double stamp = 0;
    Place at;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) std::sscanf(line.c_str(), "%lf,%lf,%lf", &stamp, &at.x, &at.y);
    odometry_ = at;
  }

  // Makes the rawlog that the programs read: never with the truth, and of the camera and the inertial unit with those
  // that are named.
  void keep_sensors(const std::string& kept) {
    std::filesystem::remove(folder_ / "mission.rawlog");
    std::string removed = "camera_ground_truth,ground_truth,tank_ground_truth";
    for (const std::string label : {"camera", "inertial"})
      if (kept.find(label) == std::string::npos) removed += "," + label;
    ASSERT_EQ(shell("rawlog-edit --remove-label " + removed + " -i run/mission.rawlog -o mission.rawlog"), 0)
        << read_file(folder_ / "log");
  }

  int shell(const std::string& command) const {
    return std::system(("cd " + folder_.path().string() + " && timeout 600 " + command + " </dev/null >>log 2>&1").c_str());
  }

  // Runs a program with its configuration of scripts/mrpt. Where the robot then is, relative to its start.
  Place icp() const {
    EXPECT_EQ(shell("icp-slam " RUBBLE_SOURCE_DIR "/scripts/mrpt/icp.ini mission.rawlog"), 0) << read_file(folder_ / "log");
    return end_of(read_file(folder_ / "LOG_ICP/log_estimated_path.txt"), "", 1);
  }
  Place rbpf() const {
    EXPECT_EQ(shell("rbpf-slam " RUBBLE_SOURCE_DIR "/scripts/mrpt/rbpf.ini mission.rawlog"), 0) << read_file(folder_ / "log");
    return end_of(read_file(folder_ / "LOG_RBPF/log_estimated_path.txt"), "", 1);
  }
  Place graphslam() const {
    EXPECT_EQ(shell("graphslam-engine --2d --disable-visuals -r mission.rawlog -i " RUBBLE_SOURCE_DIR "/scripts/mrpt/graphslam.ini"), 0)
        << read_file(folder_ / "log");
    return end_of(read_file(folder_ / "graphslam_results/output_graph.graph"), "VERTEX_SE2", 1);
  }

  // Says what came out, and what odometry alone would have given.
  void expect_near(const std::string& what, const Place& found, double most) const {
    std::printf("%-44s error %.3f m after a way to (%.2f, %.2f) m; odometry %.3f m\n", what.c_str(), distance(found, truth_),
                truth_.x, truth_.y, distance(odometry_, truth_));
    EXPECT_LT(distance(found, truth_), most) << what << ": " << found.x << " " << found.y;
  }

  ScratchFolder folder_;
  Place truth_, odometry_;

 private:
  static Place end_of(const std::string& text, const std::string& first_word, std::size_t skipped) {
    const std::vector<double> numbers = last_numbers(text, first_word, skipped + 2);
    return {numbers[skipped], numbers[skipped + 1]};
  }
  std::vector<double> numbers_of_truth(bool first) const {
    std::istringstream lines(read_file(folder_ / "run/robots/tank.txt"));
    std::vector<double> numbers;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      numbers.assign(std::istream_iterator<double>(words), {});
      if (first) break;
    }
    return numbers;
  }
};

// A short drive along a wall; pictures of 16 x 12 pixels, as nobody looks at them.
const std::string kShort = "--set seconds=10 --set pieces=0 --set camera.width=16 --set camera.height=16 --set trajectory.rate_hz=0.5";

TEST_F(MrptSlam, IcpFollowsACrawler) {
  record("observations", kShort);
  expect_near("icp-slam, crawler, utm30lx", icp(), 0.25);
  const std::string path = read_file(folder_ / "LOG_ICP/log_estimated_path.txt");
  EXPECT_EQ(path.find("nan"), std::string::npos);
}

TEST_F(MrptSlam, RbpfFollowsACrawlerByActions) {
  record("actions", kShort);
  expect_near("rbpf-slam, crawler, utm30lx", rbpf(), 0.3);
}

class NightlyMrptSlam : public MrptSlam {
 protected:
  // MRPT 2.5 makes no map of scans of 3-D LiDARs: the path is that of odometry, and graphslam-engine has no nodes.
  // alone: nothing is in the rawlog but odometry and scans. Then the end is nearer than a third of what odometry is off. With more the programs must come to an end and a path: which
  // scan they take for which pose then is their affair, and docs/how_to/mrpt_slam.md says by how much it is worse.
  void check_programs(const std::string& format, const std::string& which, bool rotating, bool alone) {
    const double odometry = distance(odometry_, truth_), mapped = alone ? odometry / 3 : 1000;
    if (format == "actions") expect_near("rbpf-slam" + which, rbpf(), mapped);
    if (format == "observations")
      expect_near((rotating ? "icp-slam by odometry" : "icp-slam") + which, icp(), rotating ? odometry + 0.3 : mapped);
    if (!rotating) expect_near("graphslam-engine by " + format + which, graphslam(), mapped);
  }
};

// What the robot has besides its LiDAR: nothing, its inertial unit, its depth camera, both. kinect-3d-slam reads no rawlog.
const char* const kBesides[] = {"", "inertial", "camera", "camera and inertial"};

TEST_F(NightlyMrptSlam, EveryCombination) {
  for (const std::string robot : {"crawler", "rover"}) {
    for (const std::string lidar : {"utm30lx", "vlp16"}) {
      const std::string more = "--set robot=" + robot + " --set lidar=" + lidar + " --set seconds=45";
      for (const std::string format : {"observations", "actions"}) {
        if (lidar == "vlp16" && format == "actions") continue;  // nothing would look at its scans
        record(format, more);
        for (const std::string besides : kBesides) {
          keep_sensors(besides);
          const std::string which = ", " + robot + ", " + lidar + (besides.empty() ? "" : ", " + besides);
          check_programs(format, which, lidar == "vlp16", besides.empty());
        }
      }
    }
  }
}

}  // namespace mrpt_slam_test
}  // namespace rubble::testing
