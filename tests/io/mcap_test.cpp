// MCAP files through Foxglove's readers, and the CDR of every message against Fast-CDR's.
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/ros/mcap_format.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/ros_message_reader.h"
#include "io/ros/vector_colours.h"
#include "kernel/base/error.h"
#include "render/streams/image_streams.h"
#include "tests/io/fast_cdr.h"
#include "tests/io/ros_expectation.h"
#include "tests/io/support.h"

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

// Readers take the channels of the first schema of a type: one schema for each type, or they miss topics.
TEST(McapWriter, HasOneSchemaForEachType) {
  ScratchFolder folder;
  McapWriter writer(folder / "a.mcap", McapCompression::none, 1);
  writer.add_channel({"/a", "std_msgs/msg/First", "int32 first", ""});
  writer.add_channel({"/b", "std_msgs/msg/Second", "int32 second", ""});
  const auto third = writer.add_channel({"/c", "std_msgs/msg/First", "int32 first", ""});
  writer.write(third, 5, "message");
  writer.write(0, 3, "message");
  writer.finish();
  const std::string bytes = test::read_text(folder / "a.mcap");
  std::vector<std::pair<int, std::string>> schemas, channels;  // number, or that of the schema, and name
  std::string_view left = std::string_view(bytes).substr(8);
  std::uint8_t opcode = 0;
  for (std::uint64_t size = 0; opcode != mcap::kDataEnd && take(left, opcode) && take(left, size); left.remove_prefix(size)) {
    std::string_view content = left.substr(0, size);
    std::uint16_t number = 0;
    std::uint32_t length = 0;
    take(content, number);
    if (opcode == mcap::kChannel) take(content, number);
    take(content, length);
    if (opcode == mcap::kSchema) schemas.emplace_back(number, content.substr(0, length));
    if (opcode == mcap::kChannel) channels.emplace_back(number, content.substr(0, length));
  }
  EXPECT_EQ(schemas, (decltype(schemas){{1, "std_msgs/msg/First"}, {2, "std_msgs/msg/Second"}}));
  EXPECT_EQ(channels, (decltype(channels){{1, "/a"}, {2, "/b"}, {1, "/c"}}));
  const McapSummary summary = writer.summary();
  EXPECT_EQ(summary.counts, (std::vector<std::uint32_t>{1, 0, 1}));
  EXPECT_EQ(summary.first_ns, 3);
  EXPECT_EQ(summary.last_ns, 5);
}

// What rosbag2 and its readers look for; tests/datasets has a reader of others.
TEST(McapRecorder, LeavesTheMetadataOfABag) {
  ScratchFolder folder;
  write_mcap(folder, kVariants[0]);
  const std::string yaml = test::read_text(folder / "metadata.yaml");
  for (const char* part : {"rosbag2_bagfile_information:\n  version: 5\n", "  storage_identifier: mcap\n",
                           "    nanoseconds: 99999999\n", "    nanoseconds_since_epoch: 1000000000\n",
                           "        name: /camera/rgb/image_raw\n        type: sensor_msgs/msg/Image\n",
                           "      message_count: 4\n", "durability: 1", "  relative_file_paths:\n    - \"mission.mcap\"\n"})
    EXPECT_NE(yaml.find(part), std::string::npos) << part << yaml;
}

// What viewers show that know no picture of two or three floats.
TEST(McapRecorder, GivesVectorsAsColoursWhereWanted) {
  ScratchFolder folder;
  RosOptions options{RosDepth::metres, RosPictures::raw, test::full_recording()};
  options.vector_colours = true;
  const auto recorder = make_mcap_recorder(folder / "mission.mcap", options, McapCompression::none, 1);
  test::write_full(*recorder, 0);
  recorder->finish();
  const Frame frame = test::make_full_frame(0);
  const std::size_t bytes = 3 * frame.depth.size();
  std::map<std::string, std::string> pictures;
  rubble::read_mcap(folder / "mission.mcap", [&](const RosMessage& message) {
    if (message.topic.find("/ground_truth/") == 0) pictures[std::string(message.topic)] = message.bytes;
    return true;
  });
  EXPECT_EQ(pictures.count("/ground_truth/normals/image") + pictures.count("/ground_truth/flow/image"), 0u);
  EXPECT_EQ(pictures.count("/ground_truth/instance/image"), 1u);  // a number is no vector
  for (const char* name : {"normals", "flow"}) {
    const std::string& message = pictures["/ground_truth/" + std::string(name) + "/colours/image"];
    ASSERT_GT(message.size(), bytes) << name;
    EXPECT_NE(message.find("rgb8"), std::string::npos);
    const auto colours = colour_vectors(*find_image_stream(name), frame.get<float>(name), frame.intrinsics.width);
    ASSERT_EQ(colours.size(), bytes);
    EXPECT_EQ(message.substr(message.size() - bytes), std::string(colours.begin(), colours.end())) << name;
  }
}

TEST(VectorColours, AreThoseThatTheDocumentsSay) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(colour_vectors(*find_image_stream("normals"), {0, 0, -1, 1, -1, 0, none, 0, 0}, 3), (Bytes{128, 128, 0, 255, 0, 128, 0, 0, 0}));
  // Still, a full colour to the right and far to the right, half a colour to the left, a third of a turn, unknown.
  EXPECT_EQ(colour_vectors(*find_image_stream("flow"), {0, 0, 10, 0, 99, 0, -5, 0, -10, 17.3205081f, 0, none}, 160),
            (Bytes{255, 255, 255, 255, 0, 0, 255, 0, 0, 128, 255, 255, 0, 255, 0, 0, 0, 0}));
  EXPECT_EQ(colour_vectors(*find_image_stream("position"), {0.2f, -0.2f, 7.6f}, 1), (Bytes{51, 204, 153}));
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
