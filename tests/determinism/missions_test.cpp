// Whole missions against their golden hashes: tests/determinism/missions/suite.lua.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/app/program.h"

namespace rubble::testing {
namespace missions_test {

const std::string kFolder = RUBBLE_SOURCE_DIR "/tests/determinism/missions/";

// Without what earlier runs left in a cache: light is baked anew.
std::string run_suite(const ScratchFolder& scratch, const std::string& suite, const std::string& more, const std::string& before = "") {
  const std::string cache = scratch / ("cache" + std::to_string(std::rand()));
  const Outcome outcome = run_rubble("suite " + suite + " --out " + (scratch / "out") + " --jobs 1 " + more,
                                     "env RUBBLE_CACHE=" + cache + " " + before);
  return std::to_string(outcome.exit_code) + "\n" + outcome.out + outcome.err;
}

std::string only(std::initializer_list<const char*> names) {
  std::string text;
  for (const char* name : names) text += std::string(" --only ") + name;
  return text;
}

// Each line of the suite's output that is not "ok".
std::string differences(const std::string& outcome) {
  std::istringstream lines(outcome);
  std::string line, all;
  std::getline(lines, line);
  if (line != "0") all = "exit code " + line + "\n";
  while (std::getline(lines, line))
    if (line.rfind("ok ", 0) != 0 && line.find(" passed") == std::string::npos) all += line + "\n";
  return all;
}

constexpr char kHint[] =
    "if results were meant to change: cmake --build build/release --target update_golden, and say why in the commit";

// What one processor draws in a few seconds; `make determinism` compares all of the suite.
TEST(GoldenMissions, AreThoseOfTheTable) {
  const ScratchFolder scratch;
  EXPECT_EQ(differences(run_suite(scratch, kFolder + "suite.lua", only({"painted", "lidar", "stereo", "time_of_flight"}))), "") << kHint;
}

TEST(MoreGoldenMissions, DoNotDependOnThreads) {
  const ScratchFolder scratch;
  EXPECT_EQ(differences(run_suite(scratch, kFolder + "suite.lua", "--threads 3" + only({"weather", "events"}))), "") << kHint;
}

TEST(MoreGoldenMissions, DoNotDependOnLibmsVariants) {
  const ScratchFolder scratch;
  EXPECT_EQ(differences(run_suite(scratch, kFolder + "suite.lua", only({"blur", "depth_sensor"}),
                                  "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA ")), "") << kHint;
}

// The control: a light that is moved a little, and another seed.
TEST(MoreGoldenMissions, ChangeWithLightAndSeed) {
  const ScratchFolder scratch;
  std::filesystem::copy(kFolder + "suite.golden.json", scratch / "suite.golden.json");
  const auto changed = [&](const std::string& what) {
    write_file(scratch / "suite.lua",
               "return suite { runs = { { name = 'painted', mission = '" + kFolder + "painted.lua', golden = 'all',\n"
               "  set = { 'outputs.preview=false', 'outputs.simplemap=false', 'outputs.stl=false', '" + what + "' } } } }\n");
    return differences(run_suite(scratch, scratch / "suite.lua", ""));
  };
  const std::string light = changed("light.elevation_deg=25.01"), seed = changed("seed=5");
  EXPECT_NE(light.find("frames is"), std::string::npos) << light;
  EXPECT_EQ(light.find("state_hash is"), std::string::npos) << "the pile is the same\n" << light;
  EXPECT_NE(seed.find("state_hash is"), std::string::npos) << seed;
}

#ifdef RUBBLE_LIBM_WATCH
// Which objects call libm's transcendental functions, or BLAS and LAPACK, while missions run. None of them is ours.
std::set<std::string> callers_of_libm(const ScratchFolder& scratch, const std::string& mission) {
  const std::string list = scratch / "callers.txt";
  const Outcome outcome = run_rubble("run " + mission + " --force --quiet --out " + (scratch / "watched"),
                                     "env RUBBLE_CACHE=" + (scratch / "watched_cache") + " RUBBLE_LIBM_WATCH=" + list +
                                         " LD_PRELOAD=" RUBBLE_LIBM_WATCH " ");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::set<std::string> callers;
  std::ifstream file(list);
  for (std::string name, object, place; file >> name >> object >> place;)
    callers.insert(std::filesystem::path(object).filename().string() + " " + name);
  return callers;
}

TEST(LibmWatch, SeesNoCallOfOurs) {
  const ScratchFolder scratch;
  std::set<std::string> callers;
  for (const char* mission : {"painted.lua", "scanning_crawler.lua"}) callers.merge(callers_of_libm(scratch, kFolder + mission));
  EXPECT_FALSE(callers.empty()) << "OpenCV calls exp when it is loaded: the watch sees nothing";
  for (const std::string& caller : callers) EXPECT_NE(caller.rfind("rubble ", 0), 0u) << caller;
}
#endif

}  // namespace missions_test
}  // namespace rubble::testing
