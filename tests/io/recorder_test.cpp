// What holds for every recorder alike, and the small ones.
#include "io/recording/recorder.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/datasets/tum_recorder.h"
#include "io/image/image_file.h"
#include "io/recording/contact_sheet.h"
#include "kernel/base/error.h"
#include "tests/io/all_recorders.h"
#include "tests/io/support.h"

namespace rubble {
namespace recorder_test {

using test::make_frame;
using test::read_text;
using test::ScratchFolder;

constexpr int kFrames = 5;

using test::make_full_frame;
using test::read_tree;
using test::RecorderKind;

std::unique_ptr<Recorder> make_sheet(const std::string& path) {
  for (const RecorderKind& kind : test::all_recorders(kFrames))
    if (kind.name == "contact_sheet") return kind.make(path);
  return nullptr;
}

class AnyRecorder : public ::testing::TestWithParam<RecorderKind> {};

void record(Recorder& recorder, int shift = 0) {
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = make_full_frame(i);
    frame.rgb[0] = static_cast<std::uint8_t>(frame.rgb[0] + shift);
    frame.world_from_camera.translation.x += shift;
    if (shift) std::fill(frame.rgb.begin(), frame.rgb.end(), std::uint8_t{9});
    recorder.write(frame);
  }
  recorder.finish();
}

TEST_P(AnyRecorder, WritesTheSameBytesTwiceAndOthersForOtherFrames) {
  ScratchFolder folder;
  record(*GetParam().make(folder / "a"));
  record(*GetParam().make(folder / "b"));
  record(*GetParam().make(folder / "c"), 1);
  EXPECT_FALSE(read_tree(folder / "a").empty());
  EXPECT_TRUE(read_tree(folder / "a") == read_tree(folder / "b"));
  EXPECT_FALSE(read_tree(folder / "a") == read_tree(folder / "c"));
}

TEST_P(AnyRecorder, HasItsNameOnlyWhenFinished) {
  ScratchFolder folder;
  {
    const auto recorder = GetParam().make(folder / "a");
    recorder->write(make_full_frame(0));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.part"});
  }
  EXPECT_TRUE(folder.names().empty());
}

void expect_refusal(Recorder& recorder, const Frame& frame, const std::string& part) {
  try {
    recorder.write(frame);
    ADD_FAILURE() << "the frame was accepted";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST_P(AnyRecorder, NoticesADroppedFrame) {
  ScratchFolder folder;
  const auto recorder = GetParam().make(folder / "a");
  recorder->write(make_full_frame(0));
  expect_refusal(*recorder, make_full_frame(2), "frame 1 was expected");
}

TEST_P(AnyRecorder, NoticesAStampThatDoesNotGrow) {
  ScratchFolder folder;
  const auto recorder = GetParam().make(folder / "a");
  recorder->write(make_full_frame(0));
  Frame frame = make_full_frame(1);
  frame.stamp_ns = make_full_frame(0).stamp_ns;
  expect_refusal(*recorder, frame, "is not later");
}

// Renumbered frames hide what was dropped; the stamps do not.
TEST_P(AnyRecorder, NoticesAGapInTheStamps) {
  ScratchFolder folder;
  const auto recorder = GetParam().make(folder / "a");
  recorder->write(make_full_frame(0));
  recorder->write(make_full_frame(1));
  Frame frame = make_full_frame(3);
  frame.index = 2;
  expect_refusal(*recorder, frame, "there is a gap in the stamps");
}

// A flight follows the settling that was watched before it, after a pause and at a rate of its own.
TEST_P(AnyRecorder, TakesAPauseBetweenSequences) {
  ScratchFolder folder;
  const auto recorder = GetParam().make(folder / "a");
  recorder->write(make_full_frame(0));
  recorder->write(make_full_frame(1));
  Frame next = make_full_frame(4);
  next.index = 2;
  next.starts_sequence = true;
  recorder->write(next);
  next = make_full_frame(6);
  next.index = 3;
  recorder->write(next);
  Frame late = make_full_frame(10);
  late.index = 4;
  expect_refusal(*recorder, late, "there is a gap in the stamps");
}

TEST_P(AnyRecorder, NoticesAPictureOfTheWrongSize) {
  ScratchFolder folder;
  const auto recorder = GetParam().make(folder / "a");
  Frame frame = make_full_frame(0);
  frame.depth.pop_back();
  expect_refusal(*recorder, frame, "depth picture");
}

TEST_P(AnyRecorder, ReportsAFolderThatIsNotThere) {
  EXPECT_THROW(GetParam().make("/nonexistent/folder/a"), RunError);
}

// A folder stands where the file should be: that is found out before the first frame.
TEST_P(AnyRecorder, ReportsAPathThatIsTaken) {
  ScratchFolder folder;
  std::filesystem::create_directories(folder / "a/inside");
  EXPECT_THROW(GetParam().make(folder / "a"), RunError);
}

TEST_P(AnyRecorder, ReportsAFolderThatIsReadOnly) {
  // No one can create files there, not even the superuser.
  if (!test::exists("/proc/version")) GTEST_SKIP() << "no /proc here";
  EXPECT_THROW(GetParam().make("/proc/a"), RunError);
}

INSTANTIATE_TEST_SUITE_P(All, AnyRecorder, ::testing::ValuesIn(test::all_recorders(kFrames)),
                         [](const auto& test) { return test.param.name; });

TEST(TumTrajectory, HoldsThePoseOfTheOpticalFrame) {
  ScratchFolder folder;
  const auto recorder = make_tum_trajectory_recorder(folder / "groundtruth.txt");
  Frame frame = make_frame(0);
  frame.stamp_ns = 1'000'000'007;
  frame.world_from_camera = {{}, {1, 2, 3}};  // looks along X
  recorder->write(frame);
  recorder->finish();
  std::istringstream lines(read_text(folder / "groundtruth.txt"));
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  EXPECT_EQ(last,
            "1.000000007 1.000000000 2.000000000 3.000000000 "
            "-0.500000000 0.500000000 -0.500000000 0.500000000");
}

TEST(DepthEncoding, RoundsAndMarksWhatIsNoReturn) {
  const auto encoded = encode_depth(
      {1.0f, 1.0004f, 1.0006f, NAN, 0.0f, -1.0f, INFINITY, 65.535f, 65.536f, 0.0001f}, 0.001);
  EXPECT_EQ(encoded, (std::vector<std::uint16_t>{1000, 1000, 1001, 0, 0, 0, 0, 65535, 0, 1}));
}

TEST(ImageFile, RoundTripsColourAndDepth) {
  ScratchFolder folder;
  const Frame frame = make_frame(3);
  const RgbImage colour{96, 64, frame.rgb};
  const DepthImage depth{96, 64, encode_depth(frame.depth, 0.001)};
  write_png(folder / "c.png", colour);
  write_png(folder / "d.png", depth);
  const RgbImage colour_back = read_rgb_png(folder / "c.png");
  const DepthImage depth_back = read_depth_png(folder / "d.png");
  EXPECT_EQ(colour_back.width, 96);
  EXPECT_EQ(colour_back.height, 64);
  EXPECT_EQ(colour_back.rgb, colour.rgb);
  EXPECT_EQ(depth_back.values, depth.values);
  EXPECT_THROW(read_depth_png(folder / "c.png"), InputError);
  EXPECT_THROW(read_rgb_png(folder / "missing.png"), InputError);
}

TEST(ImageFile, RefusesEveryTruncationAndForeignFiles) {
  ScratchFolder folder;
  const std::string whole = encode_png(RgbImage{8, 8, make_frame(0, 8, 8).rgb});
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    write_text_file(folder / "cut.png", whole.substr(0, size));
    EXPECT_THROW(read_rgb_png(folder / "cut.png"), InputError) << size << " bytes";
  }
  write_text_file(folder / "foreign.png", "this is no picture at all");
  EXPECT_THROW(read_rgb_png(folder / "foreign.png"), InputError);
}

TEST(ContactSheet, ShowsTheFirstAndTheLastFrameAndTheirDepth) {
  ScratchFolder folder;
  record(*make_sheet(folder / "preview.png"));
  const RgbImage sheet = read_rgb_png(folder / "preview.png");
  // Two pairs of two 96-pixel pictures a row, three rows of them, 64 pixels high each.
  EXPECT_EQ(sheet.width, 20 + 2 * (2 * 96 + 4 + 20));
  EXPECT_GT(sheet.height, 3 * 64);
  const auto pixel = [&](int x, int y) {
    const auto* p = sheet.rgb.data() + 3 * (y * sheet.width + x);
    return std::vector<int>{p[0], p[1], p[2]};
  };
  // At this size a tile is the picture itself: colour tells column, row and index.
  EXPECT_EQ(pixel(20 + 10, 52 + 30), (std::vector<int>{10, 30, 200}));
  const std::vector<int> sky = pixel(20 + 96 + 4 + 1, 52 + 1);
  const std::vector<int> ground = pixel(20 + 96 + 4 + 40, 52 + 60);
  EXPECT_EQ(sky, (std::vector<int>{46, 48, 52})) << "no return is grey";
  EXPECT_NE(ground, sky);
}

// A sensor that has gone 4 m along X sees a post on its left: where it is now is in colour, where it was seen first is grey.
TEST(ContactSheet, ShowsTheScansOfALidarFromAbove) {
  ScratchFolder folder;
  ContactSheetOptions options;
  options.total_frames = 2;
  options.tile = 96;
  options.columns = 2;
  options.scanner = "scan";
  const auto recorder = make_contact_sheet_recorder(folder / "preview.png", options);
  const auto scan_at = [](double x, int index, int sensor) {
    RangeScan scan;
    scan.stamp_ns = 1000 + index;
    scan.index = index;
    scan.world_from_sensor = {Pose{Quat{}, {x, 0, 0.3}}};
    ScanPoint post;
    post.y = sensor == 0 ? 1.5F : -1.5F;  // only those of the first sensor are shown
    scan.points = {post};
    return Reading{sensor, scan.stamp_ns, {}, std::make_shared<const RangeScan>(scan)};
  };
  recorder->write_reading(scan_at(0, 0, 0));
  recorder->write_reading(scan_at(0, 0, 1));
  recorder->write(make_frame(0));
  recorder->write_reading(scan_at(4, 1, 0));
  recorder->write(make_frame(1));
  recorder->finish();
  const RgbImage sheet = read_rgb_png(folder / "preview.png");
  const int triple = 3 * 96 + 2 * 4;
  ASSERT_EQ(sheet.width, 20 + 2 * (triple + 20));
  // 7 m fit into 96 pixels: the way with 1.5 m about it.
  const auto saturation = [&](int frame, double x, double y) {
    const int column = 20 + frame * (triple + 20) + 2 * (96 + 4) + int(96 * (x + 1.5) / 7), row = 52 + int(32 - 96 * y / 7);
    int strongest = 0;
    for (int v = row - 1; v <= row + 1; ++v)
      for (int u = column - 1; u <= column + 1; ++u) {
        const auto* p = sheet.rgb.data() + 3 * (v * sheet.width + u);
        strongest = std::max(strongest, *std::max_element(p, p + 3) - *std::min_element(p, p + 3));
      }
    return strongest;
  };
  EXPECT_GT(saturation(0, 0, 1.5), 80) << "the post, seen now";
  EXPECT_LT(saturation(1, 0, 1.5), 40) << "the post, seen before";
  EXPECT_GT(saturation(1, 4, 1.5), 80) << "the post, seen from where the sensor is now";
  EXPECT_LT(saturation(0, 4, 1.5), 40) << "not yet";
  EXPECT_LT(saturation(0, 0, -1.5), 40) << "of another LiDAR";
}

TEST(ContactSheet, FailsWhenFramesAreMissingAtTheEnd) {
  ScratchFolder folder;
  const auto recorder = make_sheet(folder / "preview.png");
  recorder->write(make_frame(0));
  EXPECT_THROW(recorder->finish(), RunError);
}

TEST(ContactSheet, NamesTheOptionThatIsOutOfRange) {
  ContactSheetOptions options;
  options.total_frames = 3;
  options.tile = 5;
  try {
    make_contact_sheet_recorder("/tmp/never", options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tile"), std::string::npos) << error.what();
  }
}

}  // namespace recorder_test
}  // namespace rubble
