// Recordings that were cut off or altered: the fault is seen, and where it is.
#include "io/playback/recording_check.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/base/atomic_file.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/ros_message_reader.h"
#include "io/ros/rosbag_recorder.h"
#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "tests/io/support.h"

namespace rubble {
namespace recording_check_test {

using test::ScratchFolder;

struct Kind {
  const char* name;
  std::unique_ptr<Recorder> (*make)(const std::string& path);
};

std::unique_ptr<Recorder> make_bag(const std::string& p) { return make_rosbag_recorder(p); }
std::unique_ptr<Recorder> make_mcap(const std::string& p) { return make_mcap_recorder(p); }
std::unique_ptr<Recorder> make_stored_rawlog(const std::string& p) {
  return make_rawlog_recorder(p);
}
std::unique_ptr<Recorder> make_packed_rawlog(const std::string& p) {
  return make_rawlog_recorder(p, {1, 0.001, {}});
}

class Damage : public ::testing::TestWithParam<Kind> {
 protected:
  // Several chunks: a picture is larger than what closes one.
  std::string record() {
    const std::string path = folder_ / GetParam().name;
    const auto recorder = GetParam().make(path);
    for (int i = 0; i < 3; ++i) recorder->write(test::make_busy_frame(i, 560));
    recorder->finish();
    return path;
  }

  ScratchFolder folder_;
};

TEST_P(Damage, IsNotSeenInASoundFile) {
  const auto check = check_recording(record());
  ASSERT_TRUE(check);
  EXPECT_FALSE(check->fault) << check->fault->byte << " " << check->fault->what;
  if (check->kind == "gzip") return;
  EXPECT_EQ(check->messages.size(), 8u);
  EXPECT_EQ(check->messages.at("/camera/rgb/image_raw"), 3);
  EXPECT_EQ(check->messages.at("/tf_static"), 1);
}

TEST_P(Damage, OfATruncatedFileIsAtItsEnd) {
  const std::string whole = test::read_text(record()),
                    cut = folder_ / ("cut_" + std::string(GetParam().name));
  RandomStream random(7, "cuts");
  std::vector<std::size_t> sizes{0, 1, 12, whole.size() - 1};
  while (sizes.size() < 16) sizes.push_back(random.below(whole.size()));
  for (const std::size_t size : sizes) {
    write_text_file(cut, whole.substr(0, size));
    const auto check = check_recording(cut);
    ASSERT_TRUE(check);
    ASSERT_TRUE(check->fault) << size << " of " << whole.size();
    EXPECT_LE(check->fault->byte, size);
    if (size > 5000) {
      EXPECT_GE(check->fault->byte + 40, size) << check->fault->what;
    }
  }
}

// One bit, anywhere: the fault is named at the begin of the record or chunk with it, or where that
// ends; a picture is one of some, so no more than a few megabytes away.
TEST_P(Damage, OfAnAlteredBitIsFoundInItsChunk) {
  const std::string whole = test::read_text(record()),
                    bad = folder_ / ("bad_" + std::string(GetParam().name));
  RandomStream random(8, "bits");
  int seen = 0, near = 0;
  constexpr int kTimes = 24;
  for (int i = 0; i < kTimes; ++i) {
    const std::size_t at = 40 + random.below(whole.size() - 40);
    std::string altered = whole;
    altered[at] = char(altered[at] ^ (1 << random.below(8)));
    write_text_file(bad, altered);
    const auto fault = find_fault(bad);
    if (!fault) continue;
    ++seen;
    near += fault->byte <= whole.size() &&
            std::max(fault->byte, at) - std::min(fault->byte, at) < 4000000;
  }
  EXPECT_EQ(seen, kTimes);
  EXPECT_EQ(near, kTimes);
}

INSTANTIATE_TEST_SUITE_P(All, Damage,
                         ::testing::Values(Kind{"lz4.bag", make_bag},
                                         Kind{"zstd.mcap", make_mcap},
                                         Kind{"stored.rawlog", make_stored_rawlog},
                                         Kind{"packed.rawlog", make_packed_rawlog}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

// The reader knows more than our writer: bags that ROS's own library wrote.
TEST(BagReader, ReadsWhatRosbagWrote) {
  ScratchFolder folder;
  const auto recorder = make_rosbag_recorder(folder / "ours.bag");
  for (int i = 0; i < 3; ++i) recorder->write(test::make_frame(i));
  recorder->finish();
  for (const char* compression : {"none", "lz4", "bz2"}) {
    const std::string theirs = folder / (std::string(compression) + ".bag");
    const auto copied = test::run_command(
        RUBBLE_PYTHON
        " -c \"import rosbag, sys\nwith rosbag.Bag(sys.argv[2], 'w', compression=sys.argv[3]) "
        "as out:\n  for m in rosbag.Bag(sys.argv[1]).read_messages(raw=True): out.write(m[0], "
        "m[1], m[2], "
        "raw=True)\" " +
        (folder / "ours.bag") + " " + theirs + " " + compression);
    ASSERT_EQ(copied.exit_code, 0) << copied.output;
    if (std::string(compression) == "bz2") {
      EXPECT_THROW(check_recording(theirs), InputError);
      continue;
    }
    const auto check = check_recording(theirs);
    ASSERT_TRUE(check);
    EXPECT_FALSE(check->fault) << check->fault->byte << " " << check->fault->what;
    EXPECT_EQ(check->messages.at("/camera/rgb/image_raw"), 3);
  }
}

TEST(RecordingCheck, KnowsWhatItDoesNotKnow) {
  ScratchFolder folder;
  write_text_file(folder / "notes.txt", "no recording");
  write_text_file(folder / "empty.bag", "");
  EXPECT_FALSE(check_recording(folder / "notes.txt"));
  EXPECT_TRUE(find_fault(folder / "empty.bag"));
  EXPECT_THROW(check_recording(folder / "missing.bag"), InputError);
}

}  // namespace recording_check_test
}  // namespace rubble
