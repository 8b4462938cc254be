// `rubble eval map` on maps of a tunnel whose errors are known in advance.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/datasets/colmap_model.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace eval_map_test {

namespace fs = std::filesystem;

// A room of 1 m by 3 m by 1 m on the ground, open towards -Y. The camera comes from outside.
const char* const kMission = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 0, placed = {
    { box = { 0.2, 3, 1.2 }, position = { -0.6, 1.5, 0.6 } },
    { box = { 0.2, 3, 1.2 }, position = { 0.6, 1.5, 0.6 } },
    { box = { 1, 3, 0.2 }, position = { 0, 1.5, 1.1 } },
    { box = { 1.4, 0.2, 1.2 }, position = { 0, 3.1, 0.6 } },
  } },
  camera = { width = 64, height = 64, fov_deg = 90 },
  outputs = { rawlog = false, bag = false, simplemap = false, preview = false, colmap = true },
  trajectory = { rate_hz = 3, waypoints = {
    { t = 0, position = { 0, -1.5, 0.5 }, look_at = { 0, 2, 0.5 } },
    { t = 1, position = { 0, -0.4, 0.5 }, look_at = { 0, 2, 0.5 } },
    { t = 2, position = { 0, 1.5, 0.5 }, look_at = { 0, 3, 0.5 } },
  } },
}
)";

// The true boxes have worn edges, which the rectangles below have not; of all samples so many per
// cent are farther than a centimetre off there, and 90 % are nearer than a millimetre.
constexpr double kWorn = 0.02;

// An ascii PLY of rectangles, each a corner and two edges.
class Rectangles {
 public:
  void add(const Vec3& corner, const Vec3& a, const Vec3& b) {
    for (const Vec3& p : {corner, corner + a, corner + a + b, corner + b}) {
      char line[96];
      std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", p.x, p.y, p.z);
      vertices_ += line;
    }
    faces_ += "4";
    for (int i = 0; i < 4; ++i) faces_ += " " + std::to_string(4 * count_ + i);
    faces_ += "\n";
    ++count_;
  }

  // The true surface between x = low and x = high; of the faces across X those strictly inside.
  void add_ground_truth(double low, double high) {
    const double x0 = std::max(-0.5, low), x1 = std::min(0.5, high);
    const double o0 = std::max(-0.7, low), o1 = std::min(0.7, high);
    for (const double x : {-0.7, -0.5, 0.5, 0.7})
      if (x > low && x < high) add({x, 0, 0}, {0, 3, 0}, {0, 0, 1.2});
    for (const double z : {1.0, 1.2}) add({x0, 0, z}, {x1 - x0, 0, 0}, {0, 3, 0});
    add({x0, 3, 0}, {x1 - x0, 0, 0}, {0, 0, 1});           // the back wall
    add({x0, 0, 1}, {x1 - x0, 0, 0}, {0, 0, 0.2});         // fronts of roof and walls
    if (low < -0.5) add({-0.7, 0, 0}, {0.2, 0, 0}, {0, 0, 1.2});
    if (high > 0.5) add({0.5, 0, 0}, {0.2, 0, 0}, {0, 0, 1.2});
    add({o0, 0, 1.2}, {o1 - o0, 0, 0}, {0, 3.2, 0});       // tops of walls
    add({low, -5, 0}, {high - low, 0, 0}, {0, 10, 0});     // the ground
  }

  std::string text() const {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(4 * count_) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(count_) +
           "\nproperty list uchar int vertex_indices\nend_header\n" + vertices_ + faces_;
  }

 private:
  std::string vertices_, faces_;
  int count_ = 0;
};

class EvalMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    write_file(*scratch_ / "mission.lua", kMission);
    const Outcome run = run_rubble("run " + (*scratch_ / "mission.lua") + " --out " + dataset());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    Rectangles whole;
    whole.add_ground_truth(-5, 5);
    write_file(*scratch_ / "whole.ply", whole.text());
  }
  static void TearDownTestSuite() { delete scratch_; }

  static std::string dataset() { return *scratch_ / "data"; }

  static nlohmann::json score(const std::string& map, const std::string& options = "") {
    const Outcome run = run_rubble("eval map " + (*scratch_ / map) + " " + dataset() +
                                   " --json --quiet --radius 0.2 --radius 0.35 " +
                                   (options.find("--range") == options.npos ? "--range 3.5 " : "") + options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    if (run.exit_code != 0) return {};
    return nlohmann::json::parse(run.out)["datasets"][0];
  }
  static double number(const nlohmann::json& row, const char* key) {
    EXPECT_TRUE(row.contains(key) && row[key].is_number()) << key << " in " << row.dump(1);
    return row.value(key, -1.0);
  }

  static inline ScratchFolder* scratch_ = nullptr;
};

// The true cameras in a world that is half as large and then moved.
void write_small_model(const std::string& truth, const std::string& folder, const Vec3& moved) {
  fs::create_directories(folder);
  const ColmapModel model = load_colmap_model(truth);
  std::string images;
  for (const ColmapImage& image : model.images) {
    Pose pose = image.camera_from_world.inverse();
    pose.translation = 0.5 * pose.translation + moved;
    const Pose p = pose.inverse();
    char line[240];
    std::snprintf(line, sizeof line, "%u %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 ", image.id,
                  p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z, p.translation.x,
                  p.translation.y, p.translation.z);
    images += line + image.name + "\n\n";
  }
  write_file(folder + "/cameras.txt", "1 PINHOLE 64 64 32 32 32 32\n");
  write_file(folder + "/images.txt", images);
  write_file(folder + "/points3D.txt", "# none\n");
}

// One camera in the table of `cameras` scores as `camera` does; another that looks back sees more.
TEST_F(EvalMap, CountsWhatAnyOfSeveralCamerasSaw) {
  const auto score_of = [&](const std::string& cameras) {
    std::string mission = kMission;
    const std::string one = "camera = { width = 64, height = 64, fov_deg = 90 },";
    const std::size_t at = mission.find(one);
    EXPECT_NE(at, std::string::npos);
    mission.replace(at, one.size(), "cameras = { " + cameras + " },");
    write_file(*scratch_ / "several.lua", mission);
    const Outcome run = run_rubble("run " + (*scratch_ / "several.lua") + " --force --out " + (*scratch_ / "several"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Outcome scored = run_rubble("eval map " + (*scratch_ / "whole.ply") + " " + (*scratch_ / "several") +
                                      " --json --quiet --radius 0.2 --radius 0.35 --range 3.5");
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(scored.out)["datasets"][0];
  };
  const std::string front = "front = { width = 64, height = 64, fov_deg = 90 }";
  const nlohmann::json single = score("whole.ply"), alone = score_of(front);
  for (const auto& [key, value] : single.items()) {
    if (key == "name") continue;
    EXPECT_EQ(alone.at(key), value) << key;
  }
  const nlohmann::json both =
      score_of(front + ", back = { width = 32, height = 32, fov_deg = 90, rpy_deg = { 0, 0, 180 } }");
  EXPECT_GT(number(both, "visible_m2"), number(single, "visible_m2") + 1);
}

TEST_F(EvalMap, FindsNothingWrongWithTheTruth) {
  const auto s = score("whole.ply");
  EXPECT_GT(number(s, "within_1cm_percent"), 100 - kWorn);
  EXPECT_LT(number(s, "median_distance_m"), 1e-6);
  EXPECT_LT(number(s, "percentile_90_distance_m"), 1e-3);
  EXPECT_GT(number(s, "complete_1cm_percent"), 99.9);
  // What the camera sees of the room: walls, roof, floor and back, 3 + 3 + 3 + 3 + 1 m2; and ground
  // in front and on both sides, bounded by the range.
  EXPECT_GT(number(s, "visible_m2"), 13);
  EXPECT_GT(number(s, "unseen_percent"), 20);  // the backs and the far ground
  EXPECT_GT(number(s, "void_found_percent"), 97);
  EXPECT_NEAR(number(s, "void_found_percent"), number(s, "void_visible_percent"), 1.5);
  // The room, less what the ball of 2 m takes of its mouth.
  EXPECT_NEAR(number(s, "void_m3"), 3, 0.2);
  for (const char* robot : {"r200", "r350"}) {
    const std::string key = robot;
    EXPECT_GT(number(s, (key + "_found_percent").c_str()), 97);
    EXPECT_EQ(number(s, (key + "_entrances").c_str()), 1);
    EXPECT_EQ(number(s, (key + "_entrances_visible").c_str()), 1);
    EXPECT_EQ(number(s, (key + "_entrances_found").c_str()), 1);
  }
}

// The half where x < 0: half of the surface and of the void; half of the mouth lets a robot of 0.2 m
// pass, and none of 0.35 m.
TEST_F(EvalMap, FindsHalfWithHalfOfTheTruth) {
  Rectangles half;
  half.add_ground_truth(-5, 0);
  write_file(*scratch_ / "half.ply", half.text());
  const auto s = score("half.ply");
  EXPECT_GT(number(s, "within_1cm_percent"), 100 - kWorn);
  EXPECT_NEAR(number(s, "complete_1cm_percent"), 50, 2);
  EXPECT_NEAR(number(s, "void_found_percent"), 50, 4);
  EXPECT_EQ(number(s, "r200_entrances_found"), 1);
  EXPECT_EQ(number(s, "r350_entrances_found"), 0);
  EXPECT_EQ(number(s, "r350_entrances_visible"), 1);
}

// A cloud 3 cm above the ground, far from the walls.
TEST_F(EvalMap, MeasuresByHowMuchAMapIsOff) {
  std::string points;
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 40; ++k)
      points += std::to_string(-1 + 0.05 * i) + " " + std::to_string(-0.95 + 0.02 * k) + " 0.03\n";
  write_file(*scratch_ / "off.ply",
             "ply\nformat ascii 1.0\nelement vertex 1600\nproperty float x\nproperty float y\n"
             "property float z\nend_header\n" + points);
  const auto s = score("off.ply");
  EXPECT_EQ(number(s, "triangles"), 0);
  EXPECT_EQ(number(s, "samples"), 1600);
  EXPECT_NEAR(number(s, "median_distance_m"), 0.03, 1e-7);
  EXPECT_NEAR(number(s, "percentile_90_distance_m"), 0.03, 1e-7);
  EXPECT_EQ(number(s, "within_2cm_percent"), 0);
  EXPECT_EQ(number(s, "within_5cm_percent"), 100);
  EXPECT_EQ(number(s, "complete_2cm_percent"), 0);
  EXPECT_GT(number(s, "complete_5cm_percent"), 1);
  EXPECT_EQ(number(s, "r200_entrances_found"), 0);
}

// What the map has in the mouth that is not there stops the robot, and stops the rays.
TEST_F(EvalMap, HoldsASurfaceThatIsNotThereAgainstTheMap) {
  Rectangles shut;
  shut.add_ground_truth(-5, 5);
  for (const double y : {-0.2, 0.0, 0.2, 0.4}) shut.add({-0.5, y, 0}, {1, 0, 0}, {0, 0, 1});
  write_file(*scratch_ / "shut.ply", shut.text());
  const auto s = score("shut.ply");
  EXPECT_LT(number(s, "within_5cm_percent"), 100);
  EXPECT_GT(number(s, "complete_1cm_percent"), 99.9);
  EXPECT_EQ(number(s, "r200_entrances_found"), 0);
  EXPECT_EQ(number(s, "r200_entrances_visible"), 1);
  EXPECT_LT(number(s, "void_found_percent"), number(score("whole.ply"), "void_found_percent"));
}

// The range bounds what counts as visible.
TEST_F(EvalMap, CountsAsVisibleWhatIsInRange) {
  const auto near = score("whole.ply", "--range 1"), far = score("whole.ply", "--range 3.5");
  EXPECT_LT(number(near, "visible_m2"), 0.8 * number(far, "visible_m2"));
  EXPECT_GT(number(near, "complete_1cm_percent"), 99.9);
}

// The map of a model that is half as large and moved; its cameras tell how.
TEST_F(EvalMap, AlignsByAModelOnlyWhenAsked) {
  const std::string folder = *scratch_ / "model";
  const Vec3 moved{1, 2, 3};
  write_small_model(dataset() + "/colmap/sparse", folder, moved);
  Rectangles small;
  small.add(moved + Vec3{-0.5, -0.4, 0}, {1, 0, 0}, {0, 0.3, 0});  // ground, in front of the room
  write_file(*scratch_ / "small.ply", small.text());
  EXPECT_LT(number(score("small.ply"), "within_5cm_percent"), 10);
  const auto s = score("small.ply", "--align " + folder);
  EXPECT_GT(number(s, "within_1cm_percent"), 100 - kWorn);
  EXPECT_LT(number(s, "percentile_90_distance_m"), 1e-5);
  const Outcome none = run_rubble("eval map " + (*scratch_ / "whole.ply") + " " + dataset() +
                                  " --align " + (*scratch_ / "nowhere"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("nowhere"), std::string::npos) << none.err;
}

TEST_F(EvalMap, WritesTablesAndDetailsTheSameForAnyThreads) {
  for (const char* threads : {"1", "2"}) {
    const std::string to = *scratch_ / threads;
    score("whole.ply", std::string("--threads ") + threads + " --details " + to + " --out " + to +
                           ".csv --out " + to + ".tex");
  }
  for (const char* name : {".csv", ".tex", "/whole_map.ply", "/whole_seen.ply", "/whole_entrances.csv"})
    EXPECT_TRUE(read_file(*scratch_ / ("1" + std::string(name))) ==
                read_file(*scratch_ / ("2" + std::string(name))))
        << name;
  EXPECT_EQ(read_file(*scratch_ / "1.csv").find("name,triangles,samples,"), 0u);
  const std::string entrances = read_file(*scratch_ / "1/whole_entrances.csv");
  EXPECT_NE(entrances.find("\n0.2,1,"), std::string::npos) << entrances;
  EXPECT_NE(entrances.find(",1,1\n"), std::string::npos) << entrances;
}

// Its corners are what it has: on the ground, where the camera sees it.
TEST_F(EvalMap, AMeshWithoutAnyAreaCountsByItsCorners) {
  Rectangles line;
  line.add({-0.2, 0.5, 0}, {0.4, 0, 0}, {});
  write_file(*scratch_ / "line.ply", line.text());
  const auto s = score("line.ply");
  EXPECT_EQ(number(s, "samples"), 4);
  EXPECT_EQ(number(s, "within_1cm_percent"), 100);
}

TEST_F(EvalMap, ASignalStopsItCleanly) {
  const Outcome stopped =
      run_rubble_and_signal("eval map " + (*scratch_ / "whole.ply") + " " + dataset() + " --voxel 0.02 --radius 0.2",
                            [](const std::string& said) { return said.find("voids ...") != std::string::npos; }, SIGTERM);
  EXPECT_EQ(stopped.exit_code, 4) << stopped.err;
}

TEST_F(EvalMap, SaysWhatIsWrongWithTheInput) {
  const auto error = [](const std::string& map, const std::string& folder) {
    const Outcome run = run_rubble("eval map " + map + " " + folder);
    EXPECT_EQ(run.exit_code, 1) << map << " " << folder;
    return run.err;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nexpected " << part;
  };
  const std::string header = "element vertex 2\nproperty float x\nproperty float y\n"
                             "property float z\nend_header\n";
  const std::string bad = *scratch_ / "bad.ply", whole = *scratch_ / "whole.ply";
  write_file(bad, "ply\nformat ascii 1.0\n" + header + "0 0 0\n0 zero 0\n");
  has(error(bad, dataset()), "bad.ply:9: not a number");
  write_file(bad, "ply\nformat binary_little_endian 1.0\n" + header + std::string(20, '\0'));
  has(error(bad, dataset()), "the file ends early");
  has(error(bad, dataset()), "byte ");
  write_file(bad, "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                  "property float z\nend_header\n");
  has(error(bad, dataset()), "holds no vertex");
  Rectangles large;
  large.add({0, 0, 0}, {1e5, 0, 0}, {0, 1e5, 0});
  write_file(bad, large.text());
  has(error(bad, dataset()), "found 1e+10 m2 (is it in metres?)");
  has(error(whole, *scratch_ / "nowhere"), "no such folder");
  has(error(whole, dataset() + " --radius 0.01"), "at least a voxel");
  has(error(whole, dataset() + " --out t.xls"), "unknown kind of file");
  has(error(whole, dataset() + " --voxel 0.004 --memory 0.05"), "use voxels of");
  fs::rename(dataset() + "/groundtruth.txt", dataset() + "/away");
  has(error(whole, dataset()), "the run has no true poses");
  fs::rename(dataset() + "/away", dataset() + "/groundtruth.txt");
}

}  // namespace eval_map_test
}  // namespace rubble::testing
