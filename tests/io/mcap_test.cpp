// MCAP files through Foxglove's readers, and the CDR of every message against Fast-CDR's.
#include <gtest/gtest.h>

#include "io/base/atomic_file.h"
#include "io/ros/mcap_recorder.h"
#include "kernel/base/error.h"
#include "tests/io/fast_cdr.h"
#include "tests/io/ros_expectation.h"

namespace rubble {
namespace mcap_test {

using test::CommandResult;
using test::FastCdr;
using test::RosVariant;
using test::ScratchFolder;

const RosVariant kVariants[] = {{ros::Version::ros2, RosDepth::millimetres, false},
                                {ros::Version::ros2, RosDepth::metres, true}};

void write_mcap(const ScratchFolder& folder, const RosVariant& variant,
                McapCompression compression = McapCompression::zstd, int threads = 2) {
  const auto recorder =
      make_mcap_recorder(folder / "mission.mcap", test::options_of(variant), compression, threads);
  test::record_and_expect(*recorder, folder, variant);
}

CommandResult read_mcap(const ScratchFolder& folder) {
  return test::run_node("read_mcap.mjs", (folder / "mission.mcap") + " " +
                                             (folder / "expected.json") + " " + folder.path());
}

TEST(McapReaders, FoxgloveFindsEveryMessageAsAStreamAndByIndex) {
  for (const RosVariant& variant : kVariants) {
    for (const McapCompression compression : {McapCompression::zstd, McapCompression::none}) {
      ScratchFolder folder;
      write_mcap(folder, variant, compression);
      const CommandResult result = read_mcap(folder);
      EXPECT_EQ(result.exit_code, 0) << result.output;
      EXPECT_NE(result.output.find("ok: 4 frames"), std::string::npos) << result.output;
    }
  }
}

// The negative control: one bit anywhere in the middle is noticed by a checksum.
TEST(McapReaders, FoxgloveNoticesAChangedBit) {
  ScratchFolder folder;
  write_mcap(folder, kVariants[0], McapCompression::none);
  std::string bytes = test::read_text(folder / "mission.mcap");
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 1);
  write_text_file(folder / "mission.mcap", bytes);
  const CommandResult result = read_mcap(folder);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.output.find("CRC"), std::string::npos) << result.output;
}

TEST(McapWriter, GivesTheSameBytesForAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 5}) {
    ScratchFolder folder;
    write_mcap(folder, kVariants[1], McapCompression::zstd, threads);
    const std::string bytes = test::read_text(folder / "mission.mcap");
    if (threads == 1) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
}

TEST(McapWriter, RefusesNegativeStamps) {
  ScratchFolder folder;
  McapWriter mcap(folder / "a.mcap", McapCompression::none, 1);
  const auto channel = mcap.add_channel({"/a", "std_msgs/msg/Empty", "", ""});
  EXPECT_THROW(mcap.write(channel, -1, ""), RunError);
  EXPECT_NO_THROW(mcap.write(channel, 0, ""));
}

constexpr ros::Version kRos2 = ros::Version::ros2;

// Seconds are int32 in ROS 2 and uint32 in ROS 1: one more would wrap round to 1901 or 1970.
TEST(RosWire, RefusesStampsThatDoNotFit) {
  constexpr std::int64_t kSecond = 1'000'000'000, kEnd2 = (std::int64_t{1} << 31) * kSecond, kEnd1 = 2 * kEnd2;
  EXPECT_NO_THROW(ros::clock(kRos2, kEnd2 - 1));
  EXPECT_THROW(ros::clock(kRos2, kEnd2), RunError);
  EXPECT_THROW(ros::clock(kRos2, -1), RunError);
  EXPECT_NO_THROW(ros::clock(ros::Version::ros1, kEnd2));
  EXPECT_NO_THROW(ros::clock(ros::Version::ros1, kEnd1 - 1));
  EXPECT_THROW(ros::clock(ros::Version::ros1, kEnd1), RunError);
}

// Frame names of every length modulo 8, so that every alignment occurs.
class Cdr : public ::testing::TestWithParam<std::string> {
 protected:
  ros::Header header_{7, 1'700'000'000'123'456'789, GetParam()};
  Pose pose_{{0.5, -0.5, 0.5, 0.25}, {1.25, -2.5, 1e-9}};
  Frame frame_ = test::make_full_frame(2, 17, 9);
};

TEST_P(Cdr, ClockAndStringEqualFastCdr) {
  EXPECT_EQ(ros::clock(kRos2, header_.stamp_ns), FastCdr().stamp(header_.stamp_ns).bytes());
  EXPECT_EQ(ros::string(kRos2, GetParam()), (FastCdr() << GetParam()).bytes());
}

TEST_P(Cdr, ImagesEqualFastCdr) {
  const auto& k = frame_.intrinsics;
  FastCdr image;
  image.header(header_) << std::uint32_t{9} << std::uint32_t{17} << std::string("rgb8")
                        << std::uint8_t{0} << std::uint32_t{51} << frame_.rgb;
  EXPECT_EQ(ros::image(kRos2, header_, k, "rgb8", 3, frame_.rgb.data()), image.bytes());
  FastCdr compressed;
  compressed.header(header_) << std::string("png") << std::vector<std::uint8_t>{1, 2, 3};
  EXPECT_EQ(ros::compressed_image(kRos2, header_, "png", "\x01\x02\x03"), compressed.bytes());
}

TEST_P(Cdr, CameraInfoEqualsFastCdr) {
  Intrinsics k = frame_.intrinsics;
  k.distortion = {0.1, -0.2, 0.003, 0.004, 0.5};
  const std::array<double, 9> matrix{k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1};
  const std::array<double, 9> identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<double, 12> projection{k.fx, 0, k.cx, -k.fx * 0.12, 0, k.fy, k.cy, 0, 0,
                                          0,    1, 0};
  FastCdr info;
  info.header(header_) << std::uint32_t{9} << std::uint32_t{17} << std::string("plumb_bob")
                       << std::vector<double>(k.distortion.begin(), k.distortion.end()) << matrix
                       << identity << projection << std::array<std::uint32_t, 6>{} << false;
  EXPECT_EQ(ros::camera_info(kRos2, header_, k, 0.12), info.bytes());
}

TEST_P(Cdr, PosesAndTransformsEqualFastCdr) {
  EXPECT_EQ(ros::pose_stamped(kRos2, header_, pose_),
            FastCdr().header(header_).pose(pose_).bytes());
  FastCdr transforms;
  (transforms << std::uint32_t{2}).header(header_) << std::string("child");
  transforms.pose(pose_).header(header_) << std::string("other");
  EXPECT_EQ(ros::transforms(kRos2, header_, {{"child", pose_}, {"other", pose_.inverse()}}),
            transforms.pose(pose_.inverse()).bytes());
}

TEST_P(Cdr, ImuAndEventsEqualFastCdr) {
  const ImuSample s = test::make_full_imu(2)[1];
  const auto diagonal = [](double v) { return std::array<double, 9>{v, 0, 0, 0, v, 0, 0, 0, v}; };
  FastCdr imu;
  imu.header(header_) << std::array<double, 4>{0, 0, 0, 1}
                      << std::array<double, 9>{-1, 0, 0, 0, 0, 0, 0, 0, 0};
  imu.vector(s.angular_velocity) << diagonal(0.5);
  imu.vector(s.linear_acceleration) << diagonal(0.25);
  EXPECT_EQ(ros::imu(kRos2, header_, s, 0.5, 0.25), imu.bytes());

  FastCdr events;
  events.header(header_) << std::uint32_t{9} << std::uint32_t{17}
                         << static_cast<std::uint32_t>(frame_.events.size());
  for (const Event& e : frame_.events) (events << e.x << e.y).stamp(e.stamp_ns) << e.brighter;
  EXPECT_EQ(ros::event_array(kRos2, header_, frame_.intrinsics, frame_.events), events.bytes());
}

INSTANTIATE_TEST_SUITE_P(Frames, Cdr,
                         ::testing::Values("", "a", "ab", "abc", "abcd", "abcde", "abcdef",
                                         "abcdefg"));

}  // namespace mcap_test
}  // namespace rubble
