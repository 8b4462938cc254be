// Suites: golden hashes, limits of metrics, and reports that CI servers read.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace rubble::testing {
namespace suite_test {

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

class Suite : public ::testing::Test {
 protected:
  void SetUp() override { write_file(scratch / "tiny.lua", kTinyMission); }

  // A suite of one run with these further members.
  void write_run(const std::string& members) {
    write_file(scratch / "s.lua",
               "return suite { runs = {\n  { name = \"one\", mission = "
               "\"tiny.lua\", " +
                   members + " },\n} }\n");
  }
  // The same, of the pile alone.
  void write_suite(const std::string& members) { write_run("pile_only = true, " + members); }
  Outcome run(const std::string& more = "") {
    return run_rubble("suite " + (scratch / "s.lua") + " --out " + (scratch / "out") + " " + more);
  }

  ScratchFolder scratch;
};

TEST_F(Suite, HoldsRunsToTheirGoldenHashesAndTakesNewOnesOnRequest) {
  write_suite("seeds = \"1..2\"");
  const Outcome none = run();
  EXPECT_EQ(none.exit_code, 5) << none.err;
  EXPECT_IN("--update takes them", none.out);
  const Outcome taken = run("--update");
  EXPECT_EQ(taken.exit_code, 0) << taken.out << taken.err;
  EXPECT_IN("\n+ one/seed_1 state_hash ", taken.out);
  const Outcome same = run();
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_IN("2 of 2 passed", same.out);

  // The control: another pile is another hash.
  write_suite("seeds = \"1..2\", set = { \"settle.gravity=9.8\" }");
  const Outcome other = run();
  EXPECT_EQ(other.exit_code, 5);
  EXPECT_IN("instead of", other.out);
  const Outcome diff = run("--update");
  EXPECT_IN("\n- one/seed_2 state_hash ", diff.out);
  EXPECT_IN("\n+ one/seed_2 state_hash ", diff.out);
  EXPECT_EQ(run().exit_code, 0);
}

TEST_F(Suite, TakesTheSeedFromOnePlace) {
  write_suite("golden = \"none\", set = { \"seed=7\" }");
  EXPECT_EQ(run().exit_code, 0);
  write_suite("golden = \"none\", seeds = \"1..2\", set = { \"seed=7\" }");
  const Outcome both = run();
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_IN("s.lua:2: runs[1].set: `seeds` gives the seeds of this entry", both.err);
}

// By what the golden file keeps: the piece, the frame and its channel. By an earlier run's datasets: the
// number of the piece, and the pixel.
TEST_F(Suite, NamesTheFirstPieceFrameAndPixelThatDiffer) {
  write_run("golden = \"all\"");
  const Outcome first = run("--update");
  ASSERT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_EQ(run().exit_code, 0);
  std::filesystem::rename(scratch / "out", scratch / "earlier");
  write_run("golden = \"all\", set = { \"wetness=0.5\" }");
  const Outcome wet = run("--against " + (scratch / "earlier"));
  EXPECT_EQ(wet.exit_code, 5);
  EXPECT_IN("frame 0 is the first that differs, in its rgb", wet.out);
  EXPECT_IN("against " + (scratch / "earlier/one"), wet.out);
  EXPECT_IN("is the first that differs: ", wet.out.substr(wet.out.find("; pixel (")));
  EXPECT_EQ(wet.out.find("piece "), std::string::npos) << "the pile is the same\n" << wet.out;
  write_run("golden = \"all\", set = { \"settle.gravity=9.8\" }");
  const Outcome heavy = run("--against " + (scratch / "earlier"));
  EXPECT_IN("     piece 0 (brick) is the first that differs\n", heavy.out);
  EXPECT_IN("piece 0 (brick) is the first that differs, in its ", heavy.out);
  std::filesystem::create_directory(scratch / "empty");
  EXPECT_IN("no earlier dataset in ", run("--against " + (scratch / "empty")).out);
  for (const char* wrong : {"none", "out"}) {
    const Outcome refused = run("--against " + (scratch / wrong));
    EXPECT_EQ(refused.exit_code, 1) << wrong;
    EXPECT_IN("--against", refused.err);
  }
}

TEST_F(Suite, HoldsMetricsToTheirLimits) {
  write_suite("golden = \"none\", expect = { pieces = { 16, 16 }, pile_height_m = { 0.05, 1 } }");
  EXPECT_EQ(run().exit_code, 0);
  write_suite("golden = \"none\", expect = { pieces = { 17, 20 }, frames = { 1, 9 } }");
  const Outcome outside = run();
  EXPECT_EQ(outside.exit_code, 5);
  EXPECT_IN("pieces is 16, not from 17 to 20", outside.out);
  EXPECT_IN("frames is expected, but this run has none", outside.out);
  write_suite("golden = \"none\", set = { \"settle.final_time_limit=0.1\" }");
  EXPECT_IN("the pile did not settle", run().out);
}

// The room in a culvert, by the suite's limits and in a batch's table; against the closed form.
TEST_F(Suite, HoldsVoidsToTheirLimits) {
  write_file(scratch / "tiny.lua",
             "return rubble.mission { pile = rubble.collapse.culvert { bore = 0.9, rows = 1, "
             "segments = 2,\n"
             "  debris = { layers = 0 } },\n"
             "  voids = { on = true, voxel = 0.03, radius = 0.3 } }\n");
  // Two pipes of 1.8 m: a bore of 3.61 m and 0.45 m radius has 2.30 m3, less a cap at each end that
  // a ball of 1 m fills, 0.03 m3. Beside the pipes, above the ground, the robot has no room.
  write_suite(
      "golden = \"none\", expect = { void_reachable_m3 = { 2.0, 2.3 }, void_count = { 1, 1 } }");
  const Outcome met = run();
  EXPECT_EQ(met.exit_code, 0) << met.out;
  write_suite("golden = \"none\", expect = { void_volume_m3 = { 5, 9 } }");
  EXPECT_IN("void_volume_m3 is ", run().out);
  write_suite(
      "golden = \"none\", set = { \"voids.on=false\" }, expect = { void_volume_m3 = { 0, 9 } }");
  EXPECT_IN("this run has none (`voids.on = true`)", run().out);
  const Outcome batch = run_rubble("batch " + (scratch / "tiny.lua") +
                                   " --pile-only --seeds 1 --out " + (scratch / "many"));
  EXPECT_EQ(batch.exit_code, 0) << batch.err;
  EXPECT_IN(",void_volume_m3,", read_file(scratch / "many/index.csv"));
}

// The triangle under the slab of a bare lean-to, open at both sides, where a ball gets in.
TEST_F(Suite, CoversAllThatALeanToCovers) {
  write_file(scratch / "tiny.lua",
             "return rubble.mission { pile = rubble.collapse.lean_to { length = 4, height = 2, width = 4,\n"
             "  debris = { layers = 0 } }, voids = { on = true, voxel = 0.03, radius = 0.2 } }\n");
  // Half the height times what the slab's clear length of 3.92 m reaches along the floor, times the width.
  const double triangle = 0.5 * 2 * std::sqrt(3.92 * 3.92 - 2 * 2) * 4;
  const std::string limits = std::to_string(0.97 * triangle) + ", " + std::to_string(1.03 * triangle);
  write_suite("golden = \"none\", expect = { void_covered_m3 = { " + limits + " } }");
  EXPECT_EQ(run().exit_code, 0) << run().out;
  write_suite("golden = \"none\", expect = { void_volume_m3 = { " + limits + " } }");
  EXPECT_EQ(run().exit_code, 5) << "the ball takes some of it";
}

// What a suite measures is what `rubble voids` maps; a hill is solid in both, and no pile.
TEST_F(Suite, VoidsOnTerrainAreThoseOfTheMap) {
  const std::string data = scratch / "hill";
  const Outcome settled =
      run_rubble("settle scripts/terrain.lua --set pile.pieces_per_layer=20 --set voids.on=true "
                 "--set voids.voxel=0.06 --set voids.radius=0.15 --quiet --out " + data);
  ASSERT_EQ(settled.exit_code, 0) << settled.err;
  const Outcome mapped =
      run_rubble("voids " + data + " --voxel 0.06 --radius 0.15 --quiet --out " + data + "/voids");
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  const auto read = [](const std::string& path) { return nlohmann::json::parse(read_file(path)); };
  const nlohmann::json metrics = read(data + "/manifest.json").at("metrics");
  const nlohmann::json map = read(data + "/voids/voids.json"), robot = map.at("robots").at(0);
  EXPECT_GT(metrics.at("void_robot_m3"), 0.1);
  EXPECT_NEAR(metrics.at("void_volume_m3"), map.at("void_volume"), 1e-3);
  EXPECT_NEAR(metrics.at("void_robot_m3"), robot.at("volume"), 1e-3);
  EXPECT_NEAR(metrics.at("void_reachable_m3"), robot.at("reachable_volume"), 1e-3);
}

// Read by Python's XML parser and by libxml2, with names and texts that XML must escape.
TEST_F(Suite, WritesJUnitThatOthersRead) {
  write_file(scratch / "s.lua",
             "return suite { runs = {\n"
             "  { name = \"good\", mission = \"tiny.lua\", pile_only = true, golden = \"none\" },\n"
             "  { name = \"a<b & \\\"c\\\"\", mission = \"tiny.lua\", pile_only = true, golden "
             "= \"none\","
             " expect = { pieces = { 0, 1 } } },\n"
             "  { name = \"gone\", mission = \"]]>.lua\", golden = \"none\" },\n"
             "} }\n");
  const std::string report = scratch / "report.xml";
  const Outcome outcome = run("--junit " + report);
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_EQ(std::system(("xmllint --noout '" + report + "'").c_str()), 0);
  write_file(
      scratch / "read.py",
      "import sys, xml.etree.ElementTree as E\n"
      "s = E.parse(sys.argv[1]).getroot().find('testsuite')\n"
      "assert (s.get('tests'), s.get('failures'), s.get('errors')) == ('3', '1', '1'), s.attrib\n"
      "c = s.findall('testcase')\n"
      "assert [x.get('name') for x in c] == ['good', 'a<b & \"c\"', 'gone'], [x.get('name') for x "
      "in c]\n"
      "assert len(c[0]) == 0\n"
      "assert c[1].find('failure').get('message') == 'pieces is 16, not from 0 to 1'\n"
      "assert 'no such file' in c[2].find('error').text\n");
  EXPECT_EQ(
      std::system(("/usr/bin/python3 '" + (scratch / "read.py") + "' '" + report + "'").c_str()), 0)
      << read_file(report);
}

TEST_F(Suite, NamesMistakesWithTheirLines) {
  write_suite("expect = { pile_hight_m = { 0, 1 } }");
  const Outcome mistake = run();
  EXPECT_EQ(mistake.exit_code, 1);
  EXPECT_IN("s.lua:2: runs[1].expect.pile_hight_m: unknown key", mistake.err);
  EXPECT_IN("did you mean `pile_height_m`", mistake.err);
  write_suite("seeds = \"9..1\"");
  EXPECT_IN("runs[1].seeds: not a list of seeds", run().err);
  write_suite("golden = \"none\"");
  EXPECT_IN("did you mean `one`", run("--only ome").err);
}

TEST_F(Suite, APartOfOursPasses) {
  const Outcome ours =
      run_rubble("suite scripts/ci/suite.lua --only placed --out " + (scratch / "out"));
  EXPECT_EQ(ours.exit_code, 0) << ours.out << ours.err;
}

// The commands of the examples for CI servers, as written, on a suite of one mission.
TEST_F(Suite, ExamplesForCiServersDoWhatTheySay) {
  for (const std::string name : {"github-actions", "github-actions-package", "gitlab-ci", "gitlab-ci-package"}) {
    const std::string folder = scratch / name;
    for (const std::string& missions : {folder + "/missions", folder + "/robot/missions"}) {
      std::filesystem::create_directories(missions);
      write_file(missions + "/tiny.lua", kTinyMission);
      write_file(missions + "/suite.lua",
                 "return suite { runs = { { name = \"one\", mission = \"tiny.lua\", "
                 "golden = \"none\", expect = { frames = { 3, 3 } } } } }\n");
    }
    const std::string command = "/usr/bin/python3 '" RUBBLE_SOURCE_DIR
                                "/tests/app/ci_example.py' '" RUBBLE_SOURCE_DIR "/examples/ci/" +
                                name + ".yml' '" RUBBLE_SOURCE_DIR "' '" RUBBLE_PROGRAM "' '" +
                                folder + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
  }
}

using NightlySuite = Suite;

TEST_F(NightlySuite, OursPasses) {
  const Outcome ours = run_rubble("suite scripts/ci/suite.lua --out " + (scratch / "out"));
  EXPECT_EQ(ours.exit_code, 0) << ours.out << ours.err;
  EXPECT_IN("5 of 5 passed", ours.out);
}

}  // namespace suite_test
}  // namespace rubble::testing
