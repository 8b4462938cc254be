// recorder_bench FOLDER [FRAMES [PNG...]]: what each recorder costs at 1024x1024, as CSV: CPU and
// elapsed milliseconds a frame, frames per second, megabytes a frame. bench/performance.py puts it
// into docs/development/performance.md. PNG: pictures of 1024x1024 to take the colour from; without them each
// pixel has noise of 16 grey levels, which compresses worse than rendered concrete.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>

#include "bench/calibration.h"
#include "io/datasets/colmap_recorder.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/image/image_file.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/mrpt/simplemap_recorder.h"
#include "io/recording/contact_sheet.h"
#include "io/recording/recording_queue.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "tests/io/support.h"

namespace {

using namespace rubble;
using Recorders = std::vector<std::unique_ptr<Recorder>>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::uintmax_t size_of(const std::string& path) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(path)) return fs::file_size(path);
  std::uintmax_t size = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) size += entry.file_size();
  return size;
}

void measure(const char* name, const std::vector<Frame>& frames, int count,
             const std::vector<std::string>& paths, Recorders recorders) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = cpu_seconds();
  RecordingQueue queue(std::move(recorders));
  for (int i = 0; i < count; ++i) {
    Frame frame = frames[static_cast<std::size_t>(i) % frames.size()];
    frame.index = i;
    frame.stamp_ns = 1'000'000'000 + i * std::int64_t{33'333'333};
    queue.push(std::move(frame));
  }
  queue.finish();
  const double cpu = cpu_seconds() - cpu_start;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  double megabytes = 0;
  for (const std::string& path : paths) {
    megabytes += static_cast<double>(size_of(path)) / 1e6;
    std::filesystem::remove_all(path);
  }
  std::printf("%s,%.1f,%.1f,%.1f,%.2f\n", name, 1e3 * cpu / count, 1e3 * wall.count() / count,
              count / wall.count(), megabytes / count);
  std::fflush(stdout);
}

template <typename... R>
Recorders list(R... recorders) {
  Recorders all;
  (all.push_back(std::move(recorders)), ...);
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int count = argc > 2 ? std::atoi(argv[2]) : 30;
  std::vector<Frame> frames;
  for (int i = 0; i < 4; ++i) {
    frames.push_back(test::make_busy_frame(i, 1024));
    if (argc > 3) frames.back().rgb = read_rgb_png(argv[3 + i % (argc - 3)]).rgb;
  }
  const std::string stem = folder + "/bench.", a = stem + "a", b = stem + "b", c = stem + "c",
                    d = stem + "d", e = stem + "e";
  ContactSheetOptions sheet;
  sheet.total_frames = count;
  const RosOptions metres{RosDepth::metres, RosPictures::raw, {}};
  const RosOptions png{RosDepth::millimetres, RosPictures::png, {}};
  const RosOptions jpeg{RosDepth::millimetres, RosPictures::jpeg, {}};
  const auto run = [&](const char* name, std::unique_ptr<Recorder> recorder) {
    measure(name, frames, count, {a}, list(std::move(recorder)));
  };
  std::fputs(calibration_text(calibrate()).c_str(), stderr);
  std::printf("recorder,cpu_ms,elapsed_ms,frames_per_s,mb_per_frame\n");
  measure("none: frames copied", frames, count, {}, list());
  run("rawlog (default: gzip 0)", make_rawlog_recorder(a));
  run("rawlog gzip 1", make_rawlog_recorder(a, {1, 0.001, {}}));
  run("simplemap: every frame a key frame", make_simplemap_recorder(a, {0, 15, 160, {}, {}}));
  run("bag (default: LZ4 raw 16UC1)", make_rosbag_recorder(a));
  run("bag 32FC1", make_rosbag_recorder(a, metres));
  run("bag PNG", make_rosbag_recorder(a, png));
  run("bag JPEG", make_rosbag_recorder(a, jpeg));
  run("mcap (default: zstd raw 16UC1)", make_mcap_recorder(a));
  run("mcap 32FC1", make_mcap_recorder(a, metres));
  run("mcap JPEG", make_mcap_recorder(a, jpeg));
  run("TUM folder", make_tum_recorder(a));
  run("EuRoC folder", make_euroc_recorder(a));
  run("COLMAP folder", make_colmap_recorder(a));
  run("plain PNG and EXR", make_frames_recorder(a));
  run("trajectory", make_tum_trajectory_recorder(a));
  run("contact sheet", make_contact_sheet_recorder(a, sheet));
  measure("bag + rawlog", frames, count, {a, b},
          list(make_rosbag_recorder(a), make_rawlog_recorder(b)));
  measure("all defaults: bag + rawlog + simplemap + trajectory + contact sheet", frames, count,
          {a, b, c, d, e},
          list(make_rosbag_recorder(a), make_rawlog_recorder(b), make_simplemap_recorder(c),
               make_tum_trajectory_recorder(d), make_contact_sheet_recorder(e, sheet)));
}
