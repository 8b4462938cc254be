#include "io/state/track_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "kernel/model/track_builder.h"
#include "tests/io/support.h"

namespace rubble {
namespace track_file_test {

using test::read_text;
using test::ScratchFolder;

Track make_track(int bodies, int samples) {
  RandomStream random(7, "track test");
  TrackBuilder builder;
  for (int i = 0; i < samples; ++i) {
    builder.begin_sample(i / 60.0);
    for (int id = 0; id < bodies; ++id) {
      const Pose pose{random.rotation(), random.direction()};
      if (i >= id) builder.set({3 * id, {0.1, 0, -0.0}, pose, random.direction(), {1e30, -0.0, 1}});
    }
  }
  Track track = builder.take();
  track.bodies[0].gone = TrackBody::kStays;
  return track;
}

void write_quickly(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string error_of(const std::string& path) {
  try {
    load_track(path);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "no error";
}

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

TEST(TrackFile, ReloadsBitForBit) {
  ScratchFolder folder;
  for (const Track& track : {make_track(4, 20), Track{}}) {
    save_track(track, folder / "a");
    const Track loaded = load_track(folder / "a");
    EXPECT_EQ(loaded.hash(), track.hash());
    EXPECT_EQ(loaded.times.size(), track.times.size());
    EXPECT_EQ(loaded.bodies.size(), track.bodies.size());
    save_track(loaded, folder / "b");
    EXPECT_EQ(read_text(folder / "a"), read_text(folder / "b"));
  }
  save_track(make_track(4, 19), folder / "c");  // the negative control
  save_track(make_track(4, 20), folder / "d");
  EXPECT_NE(read_text(folder / "c"), read_text(folder / "d"));
}

TEST(TrackFile, RefusesEveryTruncationAndEveryAlteredByte) {
  ScratchFolder folder;
  save_track(make_track(2, 3), folder / "whole");
  const std::string whole = read_text(folder / "whole");
  EXPECT_EQ(error_of(folder / "whole"), "no error");  // the negative control
  for (std::size_t i = 0; i < whole.size(); ++i) {
    write_quickly(folder / "cut", whole.substr(0, i));
    EXPECT_NE(error_of(folder / "cut"), "no error") << "the first " << i << " bytes were accepted";
    std::string altered = whole;
    altered[i] = static_cast<char>(altered[i] ^ 0x10);
    write_quickly(folder / "altered", altered);
    EXPECT_NE(error_of(folder / "altered"), "no error") << "byte " << i << " could be changed";
  }
}

// With its checksum right: a file that somebody made so, or a bug of ours.
TEST(TrackFile, RefusesWhatIsNotSound) {
  ScratchFolder folder;
  const auto error_with = [&](const auto& change) {
    Track track = make_track(2, 3);
    change(track);
    save_track(track, folder / "odd");
    return error_of(folder / "odd");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_in(error_with([&](Track& t) { t.bodies[1].keys[0].world_from_body.translation.y = nan; }),
            "odd: a key has a number that is not finite");
  expect_in(error_with([](Track& t) { t.bodies[1].keys[0].sample = 40; }),
            "a key is at a sample that the track does not have");
  expect_in(error_with([](Track& t) { t.bodies[1].id = t.bodies[0].id; }),
            "the bodies are out of order");
  EXPECT_EQ(error_with([](Track&) {}), "no error");
}

TEST(TrackFile, SaysWhatIsWrong) {
  ScratchFolder folder;
  save_track(make_track(2, 3), folder / "whole");
  const std::string whole = read_text(folder / "whole");
  write_quickly(folder / "foreign", "PNG and so on, long enough to be anything at all..........");
  expect_in(error_of(folder / "foreign"), "is not a track");
  expect_in(error_of(folder / "missing"), "cannot be opened: No such file");
  write_quickly(folder / "longer", whole + "x");
  expect_in(error_of(folder / "longer"), "longer than it says");
  std::string altered = whole;
  altered[8] = 9;
  write_quickly(folder / "newer", altered);
  expect_in(error_of(folder / "newer"), "format version 9; this program reads version 1");
}

}  // namespace track_file_test
}  // namespace rubble
