// `rubble eval sfm` and `eval surface` on reconstructions whose errors are known in advance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/eval/sfm/sfm_score.h"
#include "io/mesh_formats/ply_reader.h"
#include "kernel/base/random.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace eval_sfm_test {

namespace fs = std::filesystem;

// A camera that goes round a few bricks and sees the ground beside them.
const char* const kMission = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 4, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 1 }, spawn_bounds = { 1, 1, 1 } },
  camera = { width = 64, height = 48 },
  outputs = { colmap = true, rawlog = false, bag = false, simplemap = false, preview = false },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -3, 0, 1 }, look_at = { 0, 0, 0 } },
    { t = 0.6, position = { -2, 2, 1.2 }, look_at = { 0, 0, 0 } },
    { t = 1.1, position = { 0, 3, 1.4 }, look_at = { 0, 0, 0 } },
  } },
}
)";
constexpr int kFrames = 12;

// The reconstruction's own world: half as large, turned and moved.
Similarity make_model_from_world() {
  Similarity s;
  s.scale = 0.5;
  s.rotation = normalized(Quat{0.7, 0.1, -0.5, 0.3});
  s.translation = {4, -2, 7};
  return s;
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  char word[40];
  for (const double v : values) {
    std::snprintf(word, sizeof word, " %.17g", v);
    text += word;
  }
  return text;
}

class EvalSfm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    write_file(*scratch_ / "mission.lua", kMission);
    const Outcome run =
        run_rubble("run " + (*scratch_ / "mission.lua") + " --out " + (*scratch_ / "data"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    truth_ = new SfmGroundTruth(load_sfm_ground_truth(dataset()));
    ASSERT_EQ(truth_->world_from_optical.size(), std::size_t(kFrames));
  }
  static void TearDownTestSuite() { delete truth_, delete scratch_; }

  static std::string dataset() { return *scratch_ / "data"; }

  // A model of some frames as the mapper would write it; moved: by how much each is off, in the
  // world; points: in the world.
  static void write_model(const std::string& folder, const std::vector<int>& frames,
                          const std::vector<Vec3>& moved, const std::vector<Vec3>& points) {
    const Similarity model_from_world = make_model_from_world();
    fs::create_directories(folder);
    write_file(folder + "/cameras.txt", "1 PINHOLE 64 48 32 32 32 24\n");
    std::string images, list;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Pose pose = truth_->world_from_optical[std::size_t(frames[i])];
      pose.translation += moved[i];
      const Pose p = (model_from_world * pose).inverse();
      const Quat& q = p.rotation;
      const Vec3& t = p.translation;
      images += std::to_string(i + 1) + numbers({q.w, q.x, q.y, q.z, t.x, t.y, t.z}) + " 1 " +
                truth_->model.images[std::size_t(frames[i])].name + "\n";
      for (std::size_t k = 0; i == 0 && k < points.size(); ++k)
        images += "1 2 " + std::to_string(k + 1) + " ";
      images += "\n";
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 p = model_from_world * points[k];
      list += std::to_string(k + 1) + numbers({p.x, p.y, p.z}) + " 9 9 9 " +
              (k % 2 ? "0.5" : "1.5") + " 1 " + std::to_string(k) + "\n";
    }
    write_file(folder + "/images.txt", images);
    write_file(folder + "/points3D.txt", list);
  }

  // Points above the bare ground that the cameras see.
  static std::vector<Vec3> make_points(double height, int count) {
    RandomStream random(1, "points");
    std::vector<Vec3> points;
    while (int(points.size()) < count) {
      const Vec3 p{random.uniform(-4, 4), random.uniform(-4, 4), height};
      if (std::hypot(p.x, p.y) > 3) points.push_back(p);
    }
    return points;
  }

  static nlohmann::json score(const std::string& arguments) {
    const Outcome run = run_rubble("eval sfm " + arguments + " --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    if (run.exit_code != 0) return {};
    return nlohmann::json::parse(run.out)["datasets"][0];
  }

  static inline ScratchFolder* scratch_ = nullptr;
  static inline SfmGroundTruth* truth_ = nullptr;
};

std::vector<int> range(int first, int last) {
  std::vector<int> frames;
  for (int i = first; i <= last; ++i) frames.push_back(i);
  return frames;
}

TEST_F(EvalSfm, FindsNoErrorInTheTruthTurnedAndScaled) {
  const std::string folder = dataset() + "/exact";
  write_model(folder, range(0, kFrames - 1), std::vector<Vec3>(kFrames), make_points(0, 400));
  const auto s = score(dataset() + " --model exact");
  EXPECT_EQ(s["name"], "data");
  EXPECT_EQ(s["frames"], kFrames);
  EXPECT_EQ(s["segments"], 1);
  EXPECT_EQ(s["registered"], kFrames);
  EXPECT_EQ(s["on_track"], kFrames);
  EXPECT_EQ(s["on_track_percent"], 100.0);
  EXPECT_EQ(s["points"], 400);
  EXPECT_NEAR(s["ate_rmse_m"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(s["rpe_trans_rmse_m"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(s["rpe_rot_rmse_deg"].get<double>(), 0, 1e-5);
  EXPECT_NEAR(s["reprojection_px"].get<double>(), 1, 1e-12);
  EXPECT_EQ(s["within_1cm_percent"], 100.0);
  EXPECT_NEAR(s["median_distance_m"].get<double>(), 0, 1e-6);
  EXPECT_GT(s["completeness_5cm_percent"].get<double>(), 0);
  EXPECT_LT(s["completeness_5cm_percent"].get<double>(), 20);
}

// Half of the track in each of two models, four frames in none; points 15 mm above the ground in
// one, 30 mm in the other.
TEST_F(EvalSfm, CountsSegmentsAndWhatIsNearTheSurface) {
  const std::string folder = dataset() + "/two";
  write_model(folder + "/0", range(0, 3), std::vector<Vec3>(4), make_points(0.015, 30));
  write_model(folder + "/1", range(8, 11), std::vector<Vec3>(4), make_points(0.03, 10));
  const auto s = score(dataset() + " --model " + folder);
  EXPECT_EQ(s["segments"], 2);
  EXPECT_EQ(s["registered"], 8);
  EXPECT_EQ(s["on_track"], 8);
  EXPECT_EQ(s["points"], 40);
  EXPECT_EQ(s["within_1cm_percent"], 0.0);
  EXPECT_EQ(s["within_2cm_percent"], 75.0);
  EXPECT_EQ(s["within_5cm_percent"], 100.0);
  EXPECT_NEAR(s["median_distance_m"].get<double>(), 0.015, 1e-6);
}

TEST_F(EvalSfm, LaysPointsAndTrackIntoTheWorld) {
  write_model(dataset() + "/exact", range(0, kFrames - 1), std::vector<Vec3>(kFrames),
              make_points(0.25, 7));
  const std::string folder = *scratch_ / "details";
  score(dataset() + " --model exact --details " + folder);
  const PlyMesh points = load_ply(folder + "/data_points.ply");
  const std::vector<Vec3> expected = make_points(0.25, 7);
  ASSERT_EQ(points.positions.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_LT(distance(points.positions[i], expected[i]), 1e-5);
  const std::string track = read_file(folder + "/data_track.csv");
  EXPECT_EQ(std::count(track.begin(), track.end(), '\n'), kFrames + 1);
  EXPECT_EQ(track.find("frame,image,segment,x,y,z,"), 0u);
  EXPECT_NE(track.find("\n3,000003.png,0,"), std::string::npos);
}

// One frame of twelve is 1 m off. The aligned positions follow from Eigen's umeyama in the test of
// the alignment; here it counts that this frame alone is off the track, and by how much the bound.
TEST_F(EvalSfm, TakesFramesFarFromTheTruthOffTheTrack) {
  std::vector<Vec3> moved(kFrames);
  moved[5] = {0, 0, 1};
  const std::string folder = dataset() + "/off";
  write_model(folder, range(0, kFrames - 1), moved, {});
  const auto s = score(dataset() + " --model off --bound 0.5");
  EXPECT_EQ(s["registered"], kFrames);
  EXPECT_EQ(s["on_track"], kFrames - 1);
  EXPECT_GT(s["ate_rmse_m"].get<double>(), 0.1);
  EXPECT_TRUE(s["reprojection_px"].is_null());  // no points
  EXPECT_TRUE(s["within_1cm_percent"].is_null());
  EXPECT_EQ(score(dataset() + " --model off --bound 2")["on_track"], kFrames);
}

// The ground as a mesh of 10 m by 10 m, and the half of it where x < 0: the cameras stand there or
// look across the origin, so both halves are seen.
TEST_F(EvalSfm, MeasuresHowMuchOfWhatIsSeenIsCovered) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  write_file(*scratch_ / "all.ply", header + "-5 -5 0\n5 -5 0\n5 5 0\n-5 5 0\n4 0 1 2 3\n");
  write_file(*scratch_ / "half.ply", header + "-5 -5 0\n0 -5 0\n0 5 0\n-5 5 0\n4 0 1 2 3\n");
  double covered[2];
  for (const bool whole : {false, true}) {
    const Outcome run = run_rubble("eval surface " + dataset() + " " +
                                   (*scratch_ / (whole ? "all.ply" : "half.ply")) + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto s = nlohmann::json::parse(run.out)["datasets"][0];
    EXPECT_GT(s["within_1cm_percent"].get<double>(), 99);  // the ground, less what bricks cover
    EXPECT_NEAR(s["samples"].get<double>(), (whole ? 100 : 50) / 0.02 / 0.02, 1);
    covered[whole] = s["completeness_5cm_percent"].get<double>();
  }
  EXPECT_GT(covered[1], 30);
  EXPECT_LT(covered[1], 100);
  EXPECT_GT(covered[0], 0.2 * covered[1]);
  EXPECT_LT(covered[0], 0.8 * covered[1]);
}

TEST_F(EvalSfm, WritesTablesForSpreadsheetsProgramsAndPapers) {
  write_model(dataset() + "/exact", range(0, kFrames - 1), std::vector<Vec3>(kFrames),
              make_points(0, 4));
  std::string files;
  for (const char* name : {"t.csv", "t.json", "t.tex"}) files += " --out " + (*scratch_ / name);
  const Outcome run = run_rubble("eval sfm " + dataset() + "/ --model exact" + files);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.find("data\n  sequence length"), 0u) << run.out;
  EXPECT_EQ(read_file(*scratch_ / "t.csv").find("name,frames,segments,registered,on_track,"), 0u);
  EXPECT_NE(read_file(*scratch_ / "t.csv").find("\ndata,12,1,12,12,100,4,"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(read_file(*scratch_ / "t.json"))["datasets"][0]["points"], 4);
  const std::string tex = read_file(*scratch_ / "t.tex");
  EXPECT_NE(tex.find("on track, \\%"), std::string::npos);
  EXPECT_NE(tex.find("data & 12 & 1 & 12 & 12 & 100.0 & 4 &"), std::string::npos) << tex;
  EXPECT_EQ(run_rubble("eval sfm " + dataset() + " --model exact --out t.xls").exit_code, 1);
}

TEST_F(EvalSfm, SaysWhatIsWrongWithTheInput) {
  const auto error = [](const std::string& arguments) {
    const Outcome run = run_rubble("eval sfm " + arguments);
    EXPECT_EQ(run.exit_code, 1) << arguments;
    return run.err;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nexpected " << part;
  };
  has(error(*scratch_ / "nothing"), "no such folder");
  has(error(dataset()), "data/sfm/sparse: cannot be read");
  fs::create_directories(dataset() + "/empty");
  has(error(dataset() + " --model empty"), "is no whole COLMAP model");
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"})
    write_file(dataset() + "/empty/" + name, "# nothing\n");
  has(error(dataset() + " --model empty"), "the model is empty");
  write_model(dataset() + "/bad", range(0, 3), std::vector<Vec3>(4), {});
  std::string images = read_file(dataset() + "/bad/images.txt");
  write_file(dataset() + "/bad/images.txt", images.substr(0, images.find("1 000001.png")));
  has(error(dataset() + " --model bad"), "bad/images.txt:3: the line ends early");
  images.replace(images.find("000001.png"), 10, "000099.png");
  write_file(dataset() + "/bad/images.txt", images);
  has(error(dataset() + " --model bad"), "has an image that is not in the dataset");
  images.replace(images.find("000099.png"), 10, "000000.png");
  write_file(dataset() + "/bad/images.txt", images);
  has(error(dataset() + " --model bad"), "has an image twice");
  fs::rename(dataset() + "/colmap", dataset() + "/away");
  has(error(dataset() + " --model bad"), "has no ground truth for COLMAP");
  fs::rename(dataset() + "/away", dataset() + "/colmap");
}

// On a straight track positions leave the turn about it open; directions of view do not.
TEST(AlignPoses, HoldsTheTurnAboutAStraightTrack) {
  const Similarity model_from_world = make_model_from_world();
  std::vector<Pose> from, to;
  for (int i = 0; i < 4; ++i) {
    to.push_back({normalized(Quat{1, 0.1 * i, 0.2, 0}), {double(i), 0, 0}});
    from.push_back(model_from_world * to.back());
  }
  std::vector<Vec3> a, b;
  for (const Pose& pose : from) a.push_back(pose.translation);
  for (const Pose& pose : to) b.push_back(pose.translation);
  EXPECT_FALSE(align_points(a, b, true));
  const auto found = align_poses(from, to);
  ASSERT_TRUE(found);
  const Vec3 p{1, 5, -3};
  EXPECT_LT(distance(*found * (model_from_world * p), p), 1e-9);
  EXPECT_FALSE(align_poses({from[0]}, {to[0]}));
}

}  // namespace eval_sfm_test
}  // namespace rubble::testing
