// recorder_bench FOLDER [FRAMES [PNG...]]: what each recorder costs at 1024x1024. A tool for
// developers, not a test: it prints CPU and elapsed milliseconds a frame and the size of the file.
// PNG: pictures of 1024x1024 to take the colour from; noise without them.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>

#include "io/contact_sheet.h"
#include "io/image_file.h"
#include "io/rawlog_recorder.h"
#include "io/recording_queue.h"
#include "io/rosbag_recorder.h"
#include "io/tum_recorder.h"
#include "tests/io/support.h"

namespace {

using namespace rubble;
using Recorders = std::vector<std::unique_ptr<Recorder>>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

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
    megabytes += static_cast<double>(std::filesystem::file_size(path)) / 1e6;
    std::filesystem::remove(path);
  }
  std::printf("%-28s %7.1f CPU ms %7.1f ms elapsed %7.1f frames/s %7.2f MB a frame\n", name,
              1e3 * cpu / count, 1e3 * wall.count() / count, count / wall.count(),
              megabytes / count);
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
  const std::string a = folder + "/bench.a", b = folder + "/bench.b";
  ContactSheetOptions sheet;
  sheet.total_frames = count;
  measure("nothing (copying frames)", frames, count, {}, list());
  measure("bag, uncompressed, 16UC1", frames, count, {a},
          list(make_rosbag_recorder(a, {}, BagCompression::none)));
  measure("bag, LZ4, 16UC1 (default)", frames, count, {a}, list(make_rosbag_recorder(a)));
  measure("bag, LZ4, 32FC1", frames, count, {a},
          list(make_rosbag_recorder(a, {RosDepth::metres, RosPictures::raw, {}})));
  measure("rawlog, gz 0 (default)", frames, count, {a}, list(make_rawlog_recorder(a, {0, 0.001})));
  measure("rawlog, gz 1", frames, count, {a}, list(make_rawlog_recorder(a, {1, 0.001})));
  measure("trajectory", frames, count, {a}, list(make_tum_trajectory_recorder(a)));
  measure("contact sheet", frames, count, {a}, list(make_contact_sheet_recorder(a, sheet)));
  measure("bag + rawlog, defaults", frames, count, {a, b},
          list(make_rosbag_recorder(a), make_rawlog_recorder(b)));
}
