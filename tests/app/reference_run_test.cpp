// Missions whose colours are path traced, through the program.
#include <gtest/gtest.h>

#include "tests/app/program.h"
#include "tests/base/environment.h"

namespace rubble::testing {
namespace reference_run_test {

namespace fs = std::filesystem;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ReferenceRun, StoppedWithinAnImageGoesOnToTheSameBytes) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string keys = " --set camera.quality=reference --set camera.samples=128";
  const Environment cached("RUBBLE_CACHE", scratch / "cache");
  const auto tracing = [&] {
    std::error_code failed;
    return !fs::is_empty(scratch / "cache/reference_tiles", failed) && !failed;
  };
  const Outcome stopped = run_rubble_and_signal(
      "run " + (scratch / "tiny.lua") + " --out " + (scratch / "a") + keys, tracing, SIGINT);
  ASSERT_EQ(stopped.exit_code, 4) << stopped.err;
  EXPECT_EQ(run_rubble("resume " + (scratch / "a")).exit_code, 0);
  EXPECT_TRUE(fs::is_empty(scratch / "cache/reference_tiles"));
  const Environment uncached("RUBBLE_CACHE", "off");
  const Outcome whole = run_rubble("run " + (scratch / "tiny.lua") + " --out " + (scratch / "b") + keys);
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(read_file(scratch / "a/mission.rawlog"), read_file(scratch / "b/mission.rawlog"));
}

TEST(ReferenceRun, NamesWhatIsNoQuality) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const Outcome wrong = run_rubble("check " + (scratch / "tiny.lua") + " --set camera.quality=best");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_TRUE(holds(wrong.err, "one of \"fast\", \"reference\"")) << wrong.err;
  const Outcome none = run_rubble("check " + (scratch / "tiny.lua") + " --set camera.samples=0");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_TRUE(holds(none.err, "from 1 to 65536")) << none.err;
}

}  // namespace reference_run_test
}  // namespace rubble::testing
