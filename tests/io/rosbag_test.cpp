#include <gtest/gtest.h>

#include <cstdio>

#include "io/atomic_file.h"
#include "io/bag_writer.h"
#include "io/depth_encoding.h"
#include "io/rosbag_recorder.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace {

using test::CommandResult;
using test::make_frame;
using test::run_command;
using test::ScratchFolder;

constexpr int kFrames = 4;
const std::string kScripts = std::string(RUBBLE_SOURCE_DIR) + "/tests/io";

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string frame_json(const Frame& frame) {
  const Vec3& t = frame.world_from_camera.translation;
  const Quat& q = frame.world_from_camera.rotation;
  return "{\"stamp\": {\"sec\": " + std::to_string(frame.stamp_ns / 1000000000) +
         ", \"nsec\": " + std::to_string(frame.stamp_ns % 1000000000) + "}, \"translation\": [" +
         exact(t.x) + ", " + exact(t.y) + ", " + exact(t.z) + "], \"rotation\": [" + exact(q.w) +
         ", " + exact(q.x) + ", " + exact(q.y) + ", " + exact(q.z) + "]}";
}

template <typename T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// mission.bag, and beside it what it must hold: expected.json and the raw pictures.
void write_bag_and_expectation(const ScratchFolder& folder, const RosbagOptions& options) {
  const bool raw = options.depth == BagDepth::millimetres;
  const Intrinsics k = make_frame(0).intrinsics;
  std::string json =
      "{\"width\": " + std::to_string(k.width) + ", \"height\": " + std::to_string(k.height) +
      ", \"depth\": \"" + (raw ? "16UC1" : "32FC1") + "\", \"compression\": \"" +
      (options.compress ? "lz4" : "none") + "\", \"K\": [" + exact(k.fx) + ", 0, " + exact(k.cx) +
      ", 0, " + exact(k.fy) + ", " + exact(k.cy) + ", 0, 0, 1], \"frames\": [";
  const auto recorder = make_rosbag_recorder(folder / "mission.bag", options);
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = make_frame(i);
    recorder->write(frame);
    json += (i ? ", " : "") + frame_json(frame);
    const std::string name = folder / std::to_string(i);
    write_text_file(name + ".rgb", bytes_of(frame.rgb));
    write_text_file(name + ".depth",
                    raw ? bytes_of(encode_depth(frame.depth, 0.001)) : bytes_of(frame.depth));
  }
  recorder->finish();
  write_text_file(folder / "expected.json", json + "]}\n");
}

std::string arguments(const ScratchFolder& folder) {
  return " " + (folder / "mission.bag") + " " + (folder / "expected.json") + " " + folder.path();
}

const RosbagOptions kVariants[] = {
    {BagDepth::millimetres, true}, {BagDepth::metres, true}, {BagDepth::millimetres, false}};

TEST(RosbagReaders, PythonRosbagFindsEveryPixelPoseAndStamp) {
  for (const RosbagOptions& options : kVariants) {
    ScratchFolder folder;
    write_bag_and_expectation(folder, options);
    const CommandResult result =
        run_command(RUBBLE_PYTHON " " + kScripts + "/read_bag.py" + arguments(folder));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("ok: 4 frames"), std::string::npos) << result.output;
  }
}

// The negative control of the reader scripts.
TEST(RosbagReaders, PythonRosbagNoticesAChangedPixel) {
  ScratchFolder folder;
  write_bag_and_expectation(folder, {});
  std::string pixels = test::read_text(folder / "2.rgb");
  pixels[1000] = static_cast<char>(pixels[1000] ^ 1);
  write_text_file(folder / "2.rgb", pixels);
  const CommandResult result =
      run_command(RUBBLE_PYTHON " " + kScripts + "/read_bag.py" + arguments(folder));
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.output.find("pixels of frame 2 differ"), std::string::npos) << result.output;
}

TEST(RosbagReaders, RosbagInfoAndCheckAccept) {
  ScratchFolder folder;
  write_bag_and_expectation(folder, {});
  const CommandResult info = run_command("/usr/bin/rosbag info -y " + (folder / "mission.bag"));
  EXPECT_EQ(info.exit_code, 0) << info.output;
  for (const char* part :
       {"version: 2.0", "compression: lz4", "messages: 29", "indexed: True",
        "topic: /camera/depth_registered/image_raw", "type: tf2_msgs/TFMessage"}) {
    EXPECT_NE(info.output.find(part), std::string::npos) << part << " is not in:\n" << info.output;
  }
  const CommandResult check = run_command("/usr/bin/rosbag check " + (folder / "mission.bag"));
  EXPECT_EQ(check.exit_code, 0) << check.output;
}

// npm ci goes into the build folder, once; it needs the network only then.
TEST(RosbagReaders, FoxgloveRosbagFindsEveryPixelPoseAndStamp) {
  const std::string package = RUBBLE_NODE_FOLDER;
  if (!test::exists(package + "/node_modules/.package-lock.json")) {
    const CommandResult install =
        run_command("cd " + package + " && npm ci --no-audit --no-fund --loglevel=error");
    ASSERT_EQ(install.exit_code, 0) << "npm ci failed in " << package << ":\n" << install.output;
  }
  for (const RosbagOptions& options : kVariants) {
    ScratchFolder folder;
    write_bag_and_expectation(folder, options);
    const CommandResult result =
        run_command("node " + package + "/read_bag.mjs" + arguments(folder));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("ok: 4 frames"), std::string::npos) << result.output;
  }
}

TEST(BagWriter, RefusesStampsThatRosCannotHold) {
  ScratchFolder folder;
  BagWriter bag(folder / "a.bag", BagCompression::none);
  const auto connection = bag.add_connection({"/a", "std_msgs/Empty", "", "", false});
  EXPECT_THROW(bag.write(connection, 0, ""), RunError);
  EXPECT_THROW(bag.write(connection, -1, ""), RunError);
  EXPECT_THROW(bag.write(connection, (std::int64_t{1} << 32) * 1000000000, ""), RunError);
  EXPECT_NO_THROW(bag.write(connection, 1, ""));
}

}  // namespace
}  // namespace rubble
