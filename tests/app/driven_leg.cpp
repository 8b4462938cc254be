#include "tests/app/driven_leg.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace rubble::testing {

void expect_same_frames(const ScratchFolder& folder, const std::string& leg, std::size_t least) {
  const Outcome again =
      run_rubble("run " + (folder / "out/") + leg + ".lua --quiet --out " + (folder / leg));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto json = nlohmann::json::parse(read_file(folder / (leg + "/manifest.json")));
  std::istringstream seen(read_file(folder / ("out/" + leg + ".hashes")));
  std::string row;
  std::getline(seen, row);
  std::size_t frames = 0;
  for (; std::getline(seen, row); ++frames)
    ASSERT_EQ(row, json["frame_hashes"]["xxh64"].at(frames)) << leg << " frame " << frames;
  EXPECT_EQ(frames, json["frame_hashes"]["xxh64"].size());
  EXPECT_GE(frames, least) << leg;
}

}  // namespace rubble::testing
