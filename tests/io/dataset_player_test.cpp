// Samples of recorded datasets, read back: those that went in, bit for bit where the format has every bit.
#include "io/playback/dataset_player.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/base/atomic_file.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/range_scan_recorder.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "tests/io/support.h"

namespace rubble {
namespace dataset_player_test {

using test::make_full_frame;
using test::ScratchFolder;

constexpr int kFrames = 4;

RecordedDataset dataset_in(const ScratchFolder& folder) {
  return {folder.path(), test::full_recording(), {make_full_frame(0).intrinsics}};
}

std::unique_ptr<Recorder> make_source(const std::string& name, const ScratchFolder& folder, const RosOptions& options) {
  if (name == "frames") return make_frames_recorder(folder / "frames", test::full_recording(), 1);
  if (name == "bag") return make_rosbag_recorder(folder / "mission.bag", options);
  return make_mcap_recorder(folder / "mission.mcap", options);
}

void record(const std::string& name, const ScratchFolder& folder, RosDepth depth = RosDepth::metres,
            RosPictures pictures = RosPictures::raw) {
  const auto recorder = make_source(name, folder, {depth, pictures, test::full_recording()});
  for (int i = 0; i < kFrames; ++i) test::write_full(*recorder, i);
  recorder->write_imu(test::make_full_imu(kFrames).front());  // after the last frame
  recorder->finish();
}

struct Played {
  std::vector<Frame> frames;
  std::vector<ImuSample> imus;
  std::vector<std::int64_t> stamps_ns;  // of all samples, in their order
  std::vector<std::string> notes;
};

Played play(const ScratchFolder& folder, bool imus = true, bool biases = false) {
  PlayedSamples wanted;
  wanted.imus = imus, wanted.biases = biases;
  DatasetPlayer player(dataset_in(folder), wanted);
  Played played;
  player.play([&](Sample sample) {
    played.stamps_ns.push_back(stamp_of(sample));
    if (auto* frame = std::get_if<Frame>(&sample)) played.frames.push_back(std::move(*frame));
    if (const auto* imu = std::get_if<ImuSample>(&sample)) played.imus.push_back(*imu);
  });
  played.notes = player.notes();
  return played;
}

template <typename T>
void expect_bits(const std::vector<T>& was, const std::vector<T>& is, const char* what) {
  ASSERT_EQ(was.size(), is.size()) << what;
  for (std::size_t i = 0; i < was.size(); ++i) {
    if constexpr (std::is_floating_point_v<T>)
      if (std::isnan(was[i]) && std::isnan(is[i])) continue;
    ASSERT_EQ(was[i], is[i]) << what << " " << i;
  }
}

void expect_same_frame(const Frame& was, const Frame& is) {
  EXPECT_EQ(was.stamp_ns, is.stamp_ns);
  EXPECT_EQ(was.index, is.index);
  EXPECT_EQ(was.world_from_camera.rotation, is.world_from_camera.rotation);
  EXPECT_EQ(was.world_from_camera.translation, is.world_from_camera.translation);
  EXPECT_EQ(was.baseline, is.baseline);
  expect_bits(was.rgb, is.rgb, "rgb");
  expect_bits(was.rgb_right, is.rgb_right, "right");
  expect_bits(was.depth, is.depth, "depth");
  expect_bits(was.measured_depth, is.measured_depth, "measured depth");
  for (const char* name : {"normals", "flow", "sky_visibility"}) expect_bits(was.get<float>(name), is.get<float>(name), name);
  expect_bits(was.get<std::uint32_t>("instance"), is.get<std::uint32_t>("instance"), "instance");
  expect_bits(was.get<std::uint16_t>("label"), is.get<std::uint16_t>("label"), "label");
  ASSERT_EQ(was.events.size(), is.events.size());
  for (std::size_t i = 0; i < was.events.size(); ++i) {
    EXPECT_EQ(was.events[i].stamp_ns, is.events[i].stamp_ns);
    EXPECT_EQ(was.events[i].x, is.events[i].x);
    EXPECT_EQ(was.events[i].brighter, is.events[i].brighter);
  }
}

class DatasetPlayers : public ::testing::TestWithParam<const char*> {};

TEST_P(DatasetPlayers, GiveWhatWasRecorded) {
  ScratchFolder folder;
  record(GetParam(), folder);
  const bool tables = std::string(GetParam()) == "frames";
  const Played played = play(folder, true, tables);
  ASSERT_EQ(played.frames.size(), std::size_t(kFrames));
  std::vector<ImuSample> imus;
  for (int i = 0; i < kFrames; ++i) {
    expect_same_frame(make_full_frame(i), played.frames[std::size_t(i)]);
    for (const ImuSample& sample : test::make_full_imu(i)) imus.push_back(sample);
  }
  imus.push_back(test::make_full_imu(kFrames).front());
  ASSERT_EQ(played.imus.size(), imus.size());
  for (std::size_t i = 0; i < imus.size(); ++i) {
    EXPECT_EQ(played.imus[i].stamp_ns, imus[i].stamp_ns);
    EXPECT_EQ(played.imus[i].angular_velocity, imus[i].angular_velocity);
    EXPECT_EQ(played.imus[i].linear_acceleration, imus[i].linear_acceleration);
    EXPECT_EQ(played.imus[i].acceleration_bias, tables ? imus[i].acceleration_bias : Vec3());
  }
  EXPECT_TRUE(std::is_sorted(played.stamps_ns.begin(), played.stamps_ns.end()));
  EXPECT_EQ(played.frames[1].linear_velocity.x, tables ? 3 : (played.frames[2].world_from_camera.translation.x - played.frames[0].world_from_camera.translation.x) * (1e9 / (2 * 33'333'333)));
}

INSTANTIATE_TEST_SUITE_P(All, DatasetPlayers, ::testing::Values("frames", "bag", "mcap"),
                         [](const auto& test) { return std::string(test.param); });

// PNG loses nothing of colour; depth in millimetres, and JPEG, are said to lose.
TEST(DatasetPlayer, SaysWhatCompressionLost) {
  ScratchFolder folder;
  record("bag", folder, RosDepth::millimetres, RosPictures::png);
  const Played png = play(folder, false);
  EXPECT_EQ(png.frames.at(1).rgb, make_full_frame(1).rgb);
  const Frame was = make_full_frame(1);
  for (std::size_t i = 0; i < was.measured_depth.size(); ++i)
    if (was.measured_depth[i] < 65) {
      ASSERT_NEAR(png.frames[1].measured_depth[i], was.measured_depth[i], 6e-4);
    }
  const auto says = [](const Played& played, const char* what) {
    for (const std::string& note : played.notes)
      if (note.find(what) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(says(png, "whole millimetres"));
  EXPECT_FALSE(says(png, "JPEG"));
  ScratchFolder other;
  record("mcap", other, RosDepth::metres, RosPictures::jpeg);
  EXPECT_TRUE(says(play(other, false), "JPEG"));
}

std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no refusal";
}

TEST(DatasetPlayer, SaysWhatIsMissingAndWhereAFileIsDamaged) {
  ScratchFolder folder;
  EXPECT_NE(refusal_of([&] { play(folder); }).find("outputs.bag = true"), std::string::npos);
  record("bag", folder);
  EXPECT_NE(refusal_of([&] { play(folder, true, true); }).find("no biases of imu"), std::string::npos);
  std::string bytes = test::read_text(folder / "mission.bag");
  write_text_file(folder / "mission.bag", bytes.substr(0, bytes.size() / 2));
  const std::string cut = refusal_of([&] { play(folder, false); });
  EXPECT_NE(cut.find("mission.bag: is damaged at byte"), std::string::npos) << cut;
  std::filesystem::remove(folder / "mission.bag");
  record("frames", folder);
  const std::string poses = test::read_text(folder / "frames/poses.csv");
  write_text_file(folder / "frames/poses.csv", std::string(poses).replace(poses.find("\n2,") + 1, 1, "x"));
  const std::string damaged = refusal_of([&] { play(folder, false); });
  EXPECT_NE(damaged.find("poses.csv:4: the line is damaged: expected a number, found x"), std::string::npos) << damaged;
  write_text_file(folder / "frames/poses.csv", poses);
  write_text_file(folder / "frames/rgb/000001.png", "no picture");
  EXPECT_NE(refusal_of([&] { play(folder, false); }).find("rgb/000001.png"), std::string::npos);
}

std::string cut_off(const std::string& bytes) { return bytes.substr(0, bytes.size() - 5); }

TEST(DatasetPlayer, GivesScansWithTheirTrueMotion) {
  ScratchFolder folder;
  record("frames", folder);
  Recording recording = test::full_recording();
  LidarSpec spec;
  spec.elevations_deg = {-1, 1};
  spec.delays_ns = {0, 100};
  spec.columns = 20;
  spec.column_ns = 1'000'000;
  recording.sensors = {{"lidar", "/points", "lidar_link", "", {}, std::make_shared<test::FixedScans>(spec)}};
  const auto pose = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns - 1'000'000'000) * 1e-9;
    return Pose{portable::quat_from_rpy(0, 0, 0.3 * t), {2 * t, -t, 1}};
  };
  std::vector<RangeScan> scans;
  const auto recorder = make_pcd_recorder(folder / "pcd", recording, 1);
  for (int i = 0; i < 3; ++i) {
    RangeScan& scan = scans.emplace_back();
    scan.index = i;
    scan.stamp_ns = 1'000'000'000 + i * std::int64_t{25'500'000};  // no whole milliseconds
    for (int k = 0; k < 21; ++k) scan.world_from_sensor.push_back(pose(scan.stamp_ns + k * RangeScan::kMotionStep));
    scan.points = {{1, 2, 3, 40, 0.0030001f, 1, 3}, {4, 5, 6, 50, 0.019f, 0, 19}};
    recorder->write_reading({0, scan.stamp_ns, {}, std::make_shared<const RangeScan>(scan)});
  }
  recorder->finish();
  RecordedDataset dataset = dataset_in(folder);
  dataset.recording = recording;
  PlayedSamples wanted;
  wanted.scans = true;
  DatasetPlayer player(dataset, wanted);
  std::size_t count = 0;
  player.play([&](const Sample& sample) {
    const auto* reading = std::get_if<Reading>(&sample);
    if (!reading) return;
    const RangeScan* scan = reading->scan.get();
    ASSERT_TRUE(scan);
    const RangeScan& was = scans.at(count++);
    EXPECT_EQ(scan->stamp_ns, was.stamp_ns);
    ASSERT_EQ(scan->points.size(), was.points.size());
    EXPECT_EQ(std::memcmp(scan->points.data(), was.points.data(), 2 * sizeof(ScanPoint)), 0);
    ASSERT_GE(scan->world_from_sensor.size(), 20u);
    for (std::size_t k = 0; k < 20; ++k)
      EXPECT_LT(distance(scan->world_from_sensor[k].translation, was.world_from_sensor[k].translation), 1e-8);
  });
  EXPECT_EQ(count, 3u);
  write_text_file(folder / "pcd/lidar/000001.pcd", cut_off(test::read_text(folder / "pcd/lidar/000001.pcd")));
  DatasetPlayer damaged(dataset, wanted);
  EXPECT_NE(refusal_of([&] { damaged.play([](const Sample&) {}); }).find("000001.pcd"), std::string::npos);
}

}  // namespace dataset_player_test
}  // namespace rubble
