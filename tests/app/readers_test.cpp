// The files of a real run, read by programs that we did not write.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace rubble::testing {
namespace readers_test {

// One small dataset for all tests of this file.
class Readers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    const Outcome run = run_rubble("run scripts/small.lua --out " + (*scratch_ / "data"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }

  static std::string file(const std::string& name) { return *scratch_ / ("data/" + name); }

  // Runs a command and returns what it printed; its failure is a failure of the test.
  static std::string read_with(const std::string& command) {
    const std::string log = *scratch_ / "log";
    const int status = std::system((command + " >'" + log + "' 2>&1").c_str());
    const std::string text = read_file(log);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command << "\n" << text;
    return text;
  }

  static inline ScratchFolder* scratch_ = nullptr;
};

TEST_F(Readers, RosbagListsTheTopics) {
  const std::string info = read_with("/usr/bin/python3 /usr/bin/rosbag info -y " +
                                     file("mission.bag"));
  for (const char* topic :
       {"/camera/rgb/image_raw", "/camera/rgb/camera_info", "/camera/depth_registered/image_raw",
        "/camera/depth_registered/camera_info", "/ground_truth/pose", "/tf", "/tf_static",
        "/clock"})
    EXPECT_NE(info.find(std::string(topic) + "\n"), std::string::npos) << topic << "\n" << info;
  EXPECT_NE(info.find("compression: lz4"), std::string::npos) << info;
}

TEST_F(Readers, RosbagChecksTheMessages) {
  if (std::system("/usr/bin/python3 -c 'import sys; sys.exit(sys.version_info < (3, 13))'") == 0)
    GTEST_SKIP() << "`rosbag check` of ROS 1 reads locals() that exec() made, which Python 3.13 has no more";
  read_with("/usr/bin/python3 /usr/bin/rosbag check " + file("mission.bag"));
}

TEST_F(Readers, RawlogEditCountsTheObservations) {
  std::string info = read_with("rawlog-edit --info -i " + file("mission.rawlog"));
  for (std::size_t at = 0; (at = info.find("/ 30", at)) != std::string::npos;) info.erase(at + 1, 1);  // as MRPT 2.14 writes
  for (const char* row : {"camera /      5 /30.000", "ground_truth /      5 /30.000"})
    EXPECT_NE(info.find(row), std::string::npos) << row << "\n" << info;
}

TEST_F(Readers, ExportWritesEveryFormatOfAFinishedRun) {
  const std::string out = *scratch_ / "export";
  const Outcome all = run_rubble("export " + file("") + " --quiet --out " + out);
  EXPECT_EQ(all.exit_code, 0) << all.err;
  for (const char* name : {"pile.stl", "pile.ply", "pile.obj", "pile.mtl", "pile.glb",
                           "sdf/pile.sdf", "sdf/meshes/materials.mtl", "mjcf/pile.xml", "usd/pile.usda",
                           "urdf/fixed.urdf", "urdf/scene.json"})
    EXPECT_FALSE(read_file(out + "/" + name).empty()) << name;
  EXPECT_TRUE(read_file(out + "/pile.stl") == read_file(file("pile.stl")));
  const Outcome again = run_rubble("export " + file("") + " --format ply,sdf --out " + out);
  EXPECT_EQ(again.exit_code, 1) << "the folder is not empty";
  for (const char* choice : {" --format ply,sdf", "", " --format urdf --dynamic all", ""}) {
    const Outcome forced = run_rubble("export " + file("") + choice + " --force --out " + out);
    EXPECT_EQ(forced.exit_code, 0) << choice << ": " << forced.err;
  }
  const Outcome unknown = run_rubble("export " + file("") + " --format fbx");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.err.find("stl, ply, obj, glb, sdf, mjcf, usd, urdf"), std::string::npos) << unknown.err;
}

// `--force` is for what an earlier export left.
TEST_F(Readers, ExportReplacesNoFileOfARun) {
  const std::string manifest = read_file(file("manifest.json")), stl = read_file(file("pile.stl"));
  const Outcome itself = run_rubble("export " + file("") + " --format ply --quiet --force --out " + file(""));
  EXPECT_EQ(itself.exit_code, 1);
  EXPECT_NE(itself.err.find("--out: would replace the dataset that is exported"), std::string::npos) << itself.err;
  const std::string other = *scratch_ / "other";
  ASSERT_EQ(run_rubble("settle scripts/small.lua --quiet --out " + other).exit_code, 0);
  const std::string pile = read_file(other + "/pile.stl");
  const Outcome taken = run_rubble("export " + file("") + " --format ply --quiet --force --out " + other);
  EXPECT_EQ(taken.exit_code, 1);
  EXPECT_NE(taken.err.find("--out: would replace files of the run in it"), std::string::npos) << taken.err;
  EXPECT_TRUE(read_file(other + "/pile.stl") == pile);
  EXPECT_TRUE(read_file(file("pile.stl")) == stl);
  EXPECT_EQ(read_file(file("manifest.json")), manifest);
}

TEST_F(Readers, ExportOfMeshesRefusesADynamicChoice) {
  const Outcome refused = run_rubble("export " + file("") + " --format stl,ply --dynamic all --out " + (*scratch_ / "still"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--dynamic: has no effect"), std::string::npos) << refused.err;
}

// All, none, and those near a place; every mass is that of the pile.
TEST_F(Readers, ExportFreesThePiecesThatAreAskedFor) {
  const auto count_free = [&](const std::string& choice, double& mass) {
    const std::string out = *scratch_ / "scene";
    const Outcome exported = run_rubble("export " + file("") + " --quiet --force --format mjcf --dynamic " + choice + " --out " + out);
    EXPECT_EQ(exported.exit_code, 0) << exported.err;
    const auto scene = nlohmann::json::parse(read_file(out + "/mjcf/scene.json"));
    std::size_t free = 0;
    mass = 0;
    for (const auto& model : scene["models"]) {
      free += !model["fixed"];
      for (const auto& link : model["links"]) mass += link["mass_kg"].get<double>();
    }
    const std::string xml = read_file(out + "/mjcf/pile.xml");
    std::size_t joints = 0;
    for (std::size_t at = xml.find("<freejoint"); at != std::string::npos; at = xml.find("<freejoint", at + 1)) ++joints;
    EXPECT_EQ(joints, free) << choice;
    return free;
  };
  double masses[4];
  EXPECT_EQ(count_free("none", masses[0]), 0u);
  const std::size_t all = count_free("all", masses[1]);
  EXPECT_GT(all, 30u);
  EXPECT_EQ(count_free("near=0,0,100", masses[2]), all);
  const std::size_t near = count_free("near=0,0,0,1", masses[3]);
  EXPECT_GT(near, 0u);
  EXPECT_LT(near, all);
  for (const double mass : masses) EXPECT_NEAR(mass, masses[0], 1e-9 * mass);
  for (const char* choice : {"some", "near=1,2", "near=1,2,3,4,5", "near=1,2,x", "near=0,0,-1", "near="}) {
    const Outcome refused = run_rubble(std::string("export ") + file("") + " --format mjcf --dynamic " + choice);
    EXPECT_EQ(refused.exit_code, 1) << choice;
    EXPECT_NE(refused.err.find("near=X,Y,R (an upright cylinder)"), std::string::npos) << refused.err;
  }
}

// MRPT's map of the run lies on the surface in the STL file.
TEST_F(Readers, Observations2mapPutsThePointsOnThePile) {
  write_file(file("map.ini"),
             "[MappingApplication]\npointsMap_count=1\n"
             "pointsMap_00_insertOpts_minDistBetweenLaserPoints=0\n");
  read_with("cd " + file("") + " && observations2map map.ini mission.simplemap map </dev/null");
  const std::string text =
      read_with("/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/map_on_pile.py' " +
                file("map_mrpt__maps__CSimplePointsMap_00.txt") + " " + file("pile.stl") + " 600");
  int points = 0, on_pile = 0;
  double max_mm = 0;
  ASSERT_EQ(std::sscanf(text.c_str(), "points %d max_mm %lf on_pile %d", &points, &max_mm, &on_pile),
            3)
      << text;
  EXPECT_GE(points, 500);
  EXPECT_GE(on_pile, points / 10);
  EXPECT_LT(max_mm, 2.0);
}

// The depth in the bag, at the pose in the bag, lies on the surface in the STL file.
TEST_F(Readers, DepthUnprojectsOntoThePile) {
  const std::string text =
      read_with("/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/unproject_bag.py' " +
                file("mission.bag") + " " + file("pile.stl") + " 200");
  int points = 0, on_pile = 0;
  double max_mm = 0, median_mm = 0;
  ASSERT_EQ(std::sscanf(text.c_str(), "points %d max_mm %lf median_mm %lf on_pile %d", &points,
                        &max_mm, &median_mm, &on_pile),
            4)
      << text;
  EXPECT_GE(points, 500);
  EXPECT_GE(on_pile, points / 10) << "the camera does not see the pile";
  EXPECT_LT(max_mm, 2.0);
}

}  // namespace readers_test
}  // namespace rubble::testing
