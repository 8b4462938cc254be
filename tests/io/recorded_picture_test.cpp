// Pictures read back from every recording that keeps them, against the frames that were written.
#include "io/playback/recorded_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/datasets/colmap_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "tests/io/support.h"

namespace rubble {
namespace recorded_picture_test {

using test::ScratchFolder;

constexpr int kFrames = 3;

template <typename T>
std::vector<double> numbers(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

std::vector<double> channel_of(const Frame& f, const std::string& channel) {
  if (channel == "rgb") return numbers(f.rgb);
  if (channel == "rgb_right") return numbers(f.rgb_right);
  if (channel == "depth") return numbers(f.depth);
  if (channel == "measured_depth") return numbers(f.measured_depth);
  if (channel == "normals") return numbers(f.get<float>("normals"));
  if (channel == "instance") return numbers(f.get<std::uint32_t>("instance"));
  if (channel == "label") return numbers(f.get<std::uint16_t>("label"));
  if (channel == "flow") return numbers(f.get<float>("flow"));
  return numbers(f.get<float>("sky_visibility"));
}

struct Kept {
  const char* name;  // of the file or folder
  std::unique_ptr<Recorder> (*make)(const std::string& path);
  std::vector<std::string> channels;
};

const std::vector<std::string> kAll{"rgb",      "rgb_right", "depth", "measured_depth", "normals",
                                    "instance", "label",     "flow",  "sky_visibility"};

RosOptions ros_options() { return {RosDepth::metres, RosPictures::raw, test::full_recording()}; }

std::vector<Kept> all_kept() {
  return {{"frames",
           [](const std::string& p) { return make_frames_recorder(p, test::full_recording(), 1); },
           kAll},
          {"mission.bag",
           [](const std::string& p) { return make_rosbag_recorder(p, ros_options()); }, kAll},
          {"mission.mcap",
           [](const std::string& p) { return make_mcap_recorder(p, ros_options()); }, kAll},
          {"mission.rawlog",
           [](const std::string& p) {
             return make_rawlog_recorder(p, {0, 0.001, test::full_recording()});
           },
           {"rgb", "rgb_right", "depth", "measured_depth"}},
          {"tum",
           [](const std::string& p) { return make_tum_recorder(p, test::full_recording(), 1); },
           {"rgb", "depth", "measured_depth"}},
          {"colmap",
           [](const std::string& p) { return make_colmap_recorder(p, test::full_recording(), 1); },
           {"rgb", "rgb_right"}}};
}

class RecordedPictures : public ::testing::TestWithParam<Kept> {
 protected:
  void record(int altered = -1) {
    std::filesystem::remove_all(folder_ / GetParam().name);
    const auto recorder = GetParam().make(folder_ / GetParam().name);
    for (int i = 0; i < kFrames; ++i) {
      Frame frame = test::make_full_frame(i);
      if (i == altered) frame.rgb[3 * (5 * 96 + 17) + 1] ^= 3;
      recorder->write(frame);
    }
    recorder->finish();
  }
  ScratchFolder folder_;
};

TEST_P(RecordedPictures, AreWhatWasWritten) {
  record();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = test::make_full_frame(i);
    for (const std::string& channel : GetParam().channels) {
      const auto found = find_recorded_picture(folder_.path(), {channel, i, true});
      ASSERT_TRUE(found) << channel << " of frame " << i;
      EXPECT_EQ(found->file.rfind(GetParam().name, 0), 0u) << found->file;
      EXPECT_EQ(found->width, 96);
      EXPECT_EQ(found->height, 64);
      const std::vector<double> expected = channel_of(frame, channel);
      ASSERT_EQ(found->values.size(), expected.size()) << channel;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const double is = found->values[k], wanted = expected[k];
        if (std::isnan(wanted) || found->step > 0) {
          if (std::isnan(wanted) || wanted >= 65535 * found->step) continue;
          ASSERT_NEAR(is, wanted, 0.5 * found->step + 1e-6) << channel << " " << k;
        } else {
          ASSERT_EQ(is, wanted) << channel << " " << k;
        }
      }
    }
  }
}

TEST_P(RecordedPictures, DifferAtThePixelThatWasChanged) {
  record();
  const auto was = find_recorded_picture(folder_.path(), {"rgb", 1, true});
  record(1);
  const auto is = find_recorded_picture(folder_.path(), {"rgb", 1, true});
  const auto other = find_recorded_picture(folder_.path(), {"rgb", 0, true});
  ASSERT_TRUE(was && is && other);
  EXPECT_EQ(describe_difference(*was, *was), "");
  EXPECT_EQ(
      describe_difference(*was, *is),
      "pixel (17, 5) is the first that differs: 17 6 207 instead of 17 5 207 (1 of 6144 differ)");
  EXPECT_NE(describe_difference(*was, *other), "");
}

TEST_P(RecordedPictures, AreNotThereBeyondTheLastFrameOrWhenLeftOut) {
  record();
  EXPECT_FALSE(find_recorded_picture(folder_.path(), {"rgb", kFrames, true}));
  const auto found = find_recorded_picture(folder_.path(), {"rgb", 0, true});
  ASSERT_TRUE(found);
  EXPECT_FALSE(find_recorded_picture(folder_.path(), {"rgb", 0, true}, {found->file}));
}

INSTANTIATE_TEST_SUITE_P(All, RecordedPictures, ::testing::ValuesIn(all_kept()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           return name.substr(name.find('.') + 1);
                         });

// What rounds comes last; what has losses is not taken.
TEST(RecordedPicture, PrefersWhatIsExact) {
  ScratchFolder folder;
  const auto record = [&](std::unique_ptr<Recorder> recorder) {
    recorder->write(test::make_frame(0));
    recorder->finish();
  };
  record(
      make_rosbag_recorder(folder / "mission.bag", {RosDepth::millimetres, RosPictures::jpeg, {}}));
  EXPECT_FALSE(find_recorded_picture(folder.path(), {"rgb", 0, false}));
  EXPECT_FALSE(find_recorded_picture(folder.path(), {"depth", 0, false})) << "a PNG in a message";
  record(make_rawlog_recorder(folder / "mission.rawlog"));
  EXPECT_EQ(find_recorded_picture(folder.path(), {"depth", 0, false})->file, "mission.rawlog");
  record(make_mcap_recorder(folder / "mission.mcap", {RosDepth::metres, RosPictures::raw, {}}));
  EXPECT_EQ(find_recorded_picture(folder.path(), {"depth", 0, false})->file, "mission.mcap");
}

}  // namespace recorded_picture_test
}  // namespace rubble
