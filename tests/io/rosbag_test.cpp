#include <gtest/gtest.h>

#include "io/base/atomic_file.h"
#include "io/ros/bag_writer.h"
#include "io/ros/rosbag_recorder.h"
#include "kernel/base/error.h"
#include "tests/io/ros_expectation.h"

namespace rubble {
namespace rosbag_test {

using test::CommandResult;
using test::run_command;
using test::ScratchFolder;

using test::RosVariant;

const std::string kScripts = std::string(RUBBLE_SOURCE_DIR) + "/tests/io";

struct Variant {
  RosVariant content;
  BagCompression compression;
};

const Variant kVariants[] = {
    {{ros::Version::ros1, RosDepth::millimetres, false}, BagCompression::lz4},
    {{ros::Version::ros1, RosDepth::metres, true}, BagCompression::lz4},
    {{ros::Version::ros1, RosDepth::millimetres, true}, BagCompression::none}};

// mission.bag, and beside it what it must hold.
void write_bag(const ScratchFolder& folder, const Variant& variant) {
  const auto recorder = make_rosbag_recorder(
      folder / "mission.bag", test::options_of(variant.content), variant.compression);
  test::record_and_expect(*recorder, folder, variant.content);
}

std::string arguments(const ScratchFolder& folder) {
  return " " + (folder / "mission.bag") + " " + (folder / "expected.json") + " " + folder.path();
}

CommandResult read_with_python(const ScratchFolder& folder, const Variant& variant) {
  const bool lz4 = variant.compression == BagCompression::lz4;
  return run_command(RUBBLE_PYTHON " " + kScripts + "/read_bag.py" + arguments(folder) +
                     (lz4 ? " lz4" : " none"));
}

TEST(RosbagReaders, PythonRosbagFindsEveryPixelPoseAndStamp) {
  for (const Variant& variant : kVariants) {
    ScratchFolder folder;
    write_bag(folder, variant);
    const CommandResult result = read_with_python(folder, variant);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("ok: 4 frames"), std::string::npos) << result.output;
  }
}

// The negative control of the reader scripts.
TEST(RosbagReaders, PythonRosbagNoticesAChangedPixel) {
  ScratchFolder folder;
  write_bag(folder, kVariants[0]);
  std::string pixels = test::read_text(folder / "2.rgb");
  pixels[1000] = static_cast<char>(pixels[1000] ^ 1);
  write_text_file(folder / "2.rgb", pixels);
  const CommandResult result = read_with_python(folder, kVariants[0]);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.output.find("pixels of frame 2 differ"), std::string::npos) << result.output;
}

TEST(RosbagReaders, RosbagInfoAndCheckAccept) {
  ScratchFolder folder;
  write_bag(folder, kVariants[0]);
  const CommandResult info = run_command("/usr/bin/rosbag info -y " + (folder / "mission.bag"));
  EXPECT_EQ(info.exit_code, 0) << info.output;
  for (const char* part :
       {"version: 2.0", "compression: lz4", "messages: 29", "indexed: True",
        "topic: /camera/depth_registered/image_raw", "type: tf2_msgs/TFMessage"}) {
    EXPECT_NE(info.output.find(part), std::string::npos) << part << " is not in:\n" << info.output;
  }
  // It reads locals() that exec() made, which Python 3.13 has no more.
  if (run_command("/usr/bin/python3 -c 'import sys; sys.exit(sys.version_info < (3, 13))'").exit_code == 0) return;
  const CommandResult check = run_command("/usr/bin/rosbag check " + (folder / "mission.bag"));
  EXPECT_EQ(check.exit_code, 0) << check.output;
}

TEST(RosbagReaders, FoxgloveRosbagFindsEveryPixelPoseAndStamp) {
  for (const Variant& variant : kVariants) {
    ScratchFolder folder;
    write_bag(folder, variant);
    const CommandResult result = test::run_node("read_bag.mjs", arguments(folder));
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

}  // namespace rosbag_test
}  // namespace rubble
