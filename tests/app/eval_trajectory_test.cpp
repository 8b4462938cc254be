// ATE and RPE against figures worked out by hand and against Eigen's umeyama.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "app/eval/scores/alignment.h"
#include "app/eval/scores/trajectory_error.h"
#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace eval_trajectory_test {

Pose pose_at(const Vec3& position, const Quat& rotation = {}) { return {rotation, position}; }

Quat about_z(double degrees) {
  const double half = degrees * 3.14159265358979323846 / 360;
  return {std::cos(half), 0, 0, std::sin(half)};
}

std::vector<Vec3> draw_points(RandomStream& random, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i)
    points.push_back({random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(0, 1)});
  return points;
}

TEST(Alignment, AgreesWithEigensUmeyamaOnNoisyPoints) {
  RandomStream random(1, "alignment");
  for (const bool with_scale : {false, true}) {
    for (int round = 0; round < 20; ++round) {
      const std::vector<Vec3> from = draw_points(random, 3 + round);
      const Quat turn = random.rotation();
      std::vector<Vec3> to;
      Eigen::Matrix3Xd x(3, from.size()), y(3, from.size());
      for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3 noise{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                         random.uniform(-0.3, 0.3)};
        to.push_back(2.5 * turn.rotate(from[i]) + Vec3{4, -5, 6} + noise);
        x.col(long(i)) << from[i].x, from[i].y, from[i].z;
        y.col(long(i)) << to[i].x, to[i].y, to[i].z;
      }
      const auto found = align_points(from, to, with_scale);
      ASSERT_TRUE(found);
      const Eigen::Matrix4d expected = Eigen::umeyama(x, y, with_scale);
      for (const Vec3& p : from) {
        const Eigen::Vector4d e = expected * Eigen::Vector4d(p.x, p.y, p.z, 1);
        EXPECT_LT(distance(*found * p, {e[0], e[1], e[2]}), 1e-9) << "round " << round;
      }
    }
  }
}

TEST(Alignment, GivesNothingForPointsThatDoNotDetermineIt) {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  EXPECT_FALSE(align_points(line, line, true));
  EXPECT_FALSE(align_points({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}, true));
  EXPECT_FALSE(align_points(std::vector<Vec3>(5), std::vector<Vec3>(5), false));
}

// A square of 2 m, with the estimate turned by 90 degrees, moved, and half as large.
TEST(TrajectoryError, IsNothingForAnEstimateThatIsOnlyMovedTurnedAndScaled) {
  std::vector<PosePair> pairs;
  const Vec3 corners[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 p = about_z(90).rotate(corners[i]) * 0.5 + Vec3{7, 8, 9};
    pairs.push_back({pose_at(p, about_z(90)), pose_at(corners[i])});
  }
  const TrajectoryError e = calc_trajectory_error(pairs);
  EXPECT_NEAR(e.ate_rmse_sim3, 0, 1e-12);
  EXPECT_NEAR(e.sim3_scale, 2, 1e-12);
  // Rigidly aligned, the square of 1 m lies in the middle of that of 2 m: each corner is off by
  // half a diagonal of 1 m.
  EXPECT_NEAR(e.ate_rmse_se3, std::sqrt(0.5), 1e-12);
  // Each side is 1 m instead of 2 m; the heading is right all along.
  EXPECT_NEAR(e.rpe_trans_rmse, 1, 1e-12);
  EXPECT_NEAR(e.rpe_rot_rmse_deg, 0, 1e-9);
}

// One of four steps is 0.4 m too long and turns 3 degrees too far; delta 2 sees it once, too.
TEST(TrajectoryError, RelativeErrorsAreThoseOfTheSteps) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 5; ++i) {
    const bool after = i >= 2;
    pairs.push_back({pose_at({i + (after ? 0.4 : 0), 0.1 * i * i, 0}, about_z(after ? 3 : 0)),
                     pose_at({double(i), 0.1 * i * i, 0})});
  }
  // Steps after the turn are seen in a frame that is 3 degrees off, in which the true step of
  // length l appears off by 2 l sin(1.5 degrees).
  const auto step = [](int i) { return std::hypot(1, 0.1 * ((i + 1) * (i + 1) - i * i)); };
  const double chord = 2 * std::sin(1.5 * 3.14159265358979323846 / 180);
  const double sum = 0.16 + std::pow(chord * step(2), 2) + std::pow(chord * step(3), 2);
  const TrajectoryError e = calc_trajectory_error(pairs);
  EXPECT_NEAR(e.rpe_trans_rmse, std::sqrt(sum / 4), 1e-12);
  EXPECT_NEAR(e.rpe_rot_rmse_deg, std::sqrt(9.0 / 4), 1e-9);
  const TrajectoryError two = calc_trajectory_error(pairs, 2);
  EXPECT_NEAR(two.rpe_rot_rmse_deg, std::sqrt(9.0 / 2), 1e-9);
}

// Corners of a square that are up and down in turn, which no turn and no shift makes better; six poses in the middle are
// right.
TEST(TrajectoryError, HasMeanMedianAndMaximum) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 4; ++i) {
    const Vec3 corner{i == 0 || i == 3 ? 1.0 : -1.0, i < 2 ? 1.0 : -1.0, 0};
    pairs.push_back({pose_at(corner + Vec3{0, 0, i % 2 == 0 ? 0.1 : -0.1}), pose_at(corner)});
  }
  for (int i = 0; i < 6; ++i) pairs.push_back({pose_at({}), pose_at({})});
  const TrajectoryError e = calc_trajectory_error(pairs);
  EXPECT_NEAR(e.ate_se3.mean, 0.04, 1e-12);
  EXPECT_NEAR(e.ate_se3.median, 0, 1e-12);
  EXPECT_NEAR(e.ate_se3.max, 0.1, 1e-12);
  EXPECT_NEAR(e.ate_rmse_se3, std::sqrt(0.004), 1e-12);
}

TEST(TrajectoryError, PairsEachPoseOfTheShorterWithTheNearestInTime) {
  std::vector<StampedPose> truth, estimate;
  for (int i = 0; i < 10; ++i) truth.push_back({0.1 * i, pose_at({double(i), 0, 0}), i});
  for (const double stamp : {0.104, 0.296, 0.555, 5.0}) estimate.push_back({stamp, Pose{}, 1});
  const auto pairs = associate(estimate, truth, 0.01);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].truth.translation.x, 1);
  EXPECT_EQ(pairs[1].truth.translation.x, 3);
}

const char* const kTruth =
    "# stamp tx ty tz qx qy qz qw\n"
    "1.00 0 0 0 0 0 0 1\n1.10 1 0 0 0 0 0 1\n1.20 1 1 0 0 0 0 1\n"
    "1.30 0 1 0 0 0 0 1\n";

TEST(EvalTrajectory, PrintsTheKeysThatOthersRead) {
  const ScratchFolder scratch;
  write_file(scratch / "truth.txt", kTruth);
  write_file(scratch / "estimate.csv",
             "#timestamp [ns],px,py,pz,qw,qx,qy,qz\n1000000000,0,0,0,1,0,0,0\n"
             "1100000000,2,0,0,1,0,0,0\n1200000000,2,2,0,1,0,0,0\n1300000000,0,2,0,1,0,0,0\n");
  const Outcome run = run_rubble("eval trajectory " + (scratch / "estimate.csv") + " " +
                                 (scratch / "truth.txt") + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.size(), 9u);
  EXPECT_EQ(json["pairs"], 4);
  EXPECT_NEAR(json["ate_rmse_se3_m"].get<double>(), std::sqrt(0.5), 1e-9);
  for (const char* key : {"ate_mean_se3_m", "ate_median_se3_m", "ate_max_se3_m"})
    EXPECT_NEAR(json[key].get<double>(), std::sqrt(0.5), 1e-9) << key;
  EXPECT_NEAR(json["ate_rmse_sim3_m"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(json["sim3_scale"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(json["rpe_trans_rmse_m"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(json["rpe_rot_rmse_deg"].get<double>(), 0, 1e-6);
}

// A circle of 32 m in 320 steps. The estimate goes 2 % too far in each step and turns 0.001 rad more: after a segment of n
// steps from any start it is off by a chord that a sum of complex numbers gives.
TEST(TrajectoryError, SegmentsAreThoseOfKitti) {
  constexpr double kPi = 3.14159265358979323846, kStep = 2 * kPi / 320;
  const auto chain = [&](double length, double turn) {
    std::vector<Pose> poses{Pose{}};
    for (int i = 0; i < 319; ++i) poses.push_back(poses.back() * pose_at({length, 0, 0}, about_z(turn * 180 / kPi)));
    return poses;
  };
  const std::vector<Pose> truth = chain(0.1, kStep), estimate = chain(0.102, kStep + 0.001);
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) pairs.push_back({estimate[i], truth[i]});
  const SegmentError error = calc_segment_error(pairs, 5.05);  // ends at the first pose beyond: 51 steps
  std::complex<double> t, e;
  for (int i = 0; i < 51; ++i) t += std::polar(0.1, i * kStep), e += std::polar(0.102, i * (kStep + 0.001));
  EXPECT_EQ(error.segments, 27) << "starts 0, 10, ..., 260: 268 + 51 is the last pose";
  EXPECT_NEAR(error.trans_percent, 100 * std::abs(t - e) / 5.05, 1e-9);
  EXPECT_NEAR(error.rot_deg_per_m, 51 * 0.001 * 180 / kPi / 5.05, 1e-9);
  EXPECT_EQ(calc_segment_error(pairs, 40).segments, 0);
}

// KITTI's poses have no stamps: times.txt has them, for an estimate with stamps.
TEST(EvalTrajectory, StampsKittisPosesAndDrawsThem) {
  const ScratchFolder scratch;
  std::string kitti, times, tum;
  for (int i = 0; i < 12; ++i) {
    const std::string z = std::to_string(i), x = std::to_string(i * i * 0.01);
    kitti += "1 0 0 " + x + " 0 1 0 0 0 0 1 " + z + "\n";
    times += (i < 10 ? "0." : "1.") + std::to_string(i % 10) + "\n";
    if (i % 2 == 0) tum += (i < 10 ? "0." : "1.") + std::to_string(i % 10) + " " + x + " 0 " + z + " 0 0 0 1\n";
  }
  write_file(scratch / "00.txt", kitti);
  write_file(scratch / "times.txt", times);
  write_file(scratch / "slam.txt", tum);
  const std::string both = "eval trajectory " + (scratch / "slam.txt") + " " + (scratch / "00.txt");
  const Outcome picture = run_rubble(both + " --times " + (scratch / "times.txt") + " --plot " + (scratch / "p.png"));
  EXPECT_EQ(picture.exit_code, 1);
  EXPECT_NE(picture.err.find("--plot: the name says another format: expected a file that ends with .svg, found .png"), std::string::npos)
      << picture.err;
  const Outcome run = run_rubble(both + " --times " + (scratch / "times.txt") + " --segments 2,99 --json --plot " + (scratch / "p.svg"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["pairs"], 6);
  EXPECT_NEAR(json["ate_rmse_se3_m"].get<double>(), 0, 1e-9);
  EXPECT_EQ(json["kitti"][0]["segments"], 1);
  EXPECT_NEAR(json["kitti"][0]["trans_percent"].get<double>(), 0, 1e-9);
  EXPECT_NE(run.err.find("no segment of 99 m"), std::string::npos) << run.err;
  const std::string plot = read_file(scratch / "p.svg");
  EXPECT_EQ(plot.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0u);
  for (const char* part : {">z (m)<", ">estimate, aligned<", ">error of position (m)<", ">time (s)<"})
    EXPECT_NE(plot.find(part), std::string::npos) << part;
  write_file(scratch / "few.txt", "0.0\n0.1\n");
  write_file(scratch / "bad.txt", "0\n0.1\n0.3\n0.2\n" + times.substr(16));
  for (const auto& [file, message] : {std::pair{"few.txt", "few.txt: has another number of stamps"}, {"bad.txt", "bad.txt:4: out of order"}}) {
    const Outcome bad = run_rubble(both + " --times " + (scratch / file));
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_NE(bad.err.find(message), std::string::npos) << bad.err;
  }
  EXPECT_EQ(run_rubble("eval trajectory " + (scratch / "slam.txt") + " " + (scratch / "slam.txt") + " --times " + (scratch / "times.txt")).exit_code, 1);
}

// A straight flight along X; the estimate goes along Y and is 5 cm beside it, on either side so that no turn and no
// shift is better. The turn about the line is open, the distances are not.
TEST(EvalTrajectory, ScoresAStraightFlight) {
  const ScratchFolder scratch;
  write_file(scratch / "truth.txt", "1.0 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n1.2 2 0 0 0 0 0 1\n1.3 3 0 0 0 0 0 1\n");
  write_file(scratch / "estimate.txt",
             "1.0 0.05 0 4 0 0 0 1\n1.1 -0.05 1 4 0 0 0 1\n1.2 -0.05 2 4 0 0 0 1\n1.3 0.05 3 4 0 0 0 1\n");
  const Outcome run = run_rubble("eval trajectory " + (scratch / "estimate.txt") + " " + (scratch / "truth.txt") + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_NEAR(json["ate_rmse_se3_m"].get<double>(), 0.05, 1e-9);
}

// TUM's freiburg2_desk has a stamp twice; ORB-SLAM3 writes nanoseconds into TUM's columns.
TEST(EvalTrajectory, SaysWhatItReadAndWhatIsDoubtful) {
  const ScratchFolder scratch;
  write_file(scratch / "truth.txt", std::string(kTruth) + "1.30 0 1.001 0 0 0 0 1\n1.40 0 2 1 0 0 0 1\n");
  write_file(scratch / "estimate.txt",
             "1000000000 0 0 0 0.5 -0.5 0.5 -0.5\n1100000000 1 0 0 0.5 -0.5 0.5 -0.5\n1200000000 1 1 0 0.5 -0.5 0.5 -0.5\n"
             "1400000000 0 2 1 0.5 -0.5 0.5 -0.5\n");
  const Outcome run = run_rubble("eval trajectory " + (scratch / "estimate.txt") + " " + (scratch / "truth.txt") + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(nlohmann::json::parse(run.out)["ate_rmse_se3_m"].get<double>(), 0, 1e-9);
  for (const char* words : {"estimate.txt: 4 poses, read as TUM", "stamps in ns", "truth.txt: line 6 repeats the stamp",
                            "differ by the same turn of 120 degrees"})
    EXPECT_NE(run.err.find(words), std::string::npos) << words << "\n" << run.err;
  std::string late;
  for (int i = 0; i < 9; ++i) late += "1." + std::to_string(i) + "5 0 " + std::to_string(i * i) + " 0 0 0 0 1\n";
  write_file(scratch / "late.txt", "1.0 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n1.2 1 1 0 0 0 0 1\n" + late.substr(late.find("1.25")));
  write_file(scratch / "long.txt", kTruth + late.substr(late.find("1.85")) + "2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n4 0 0 0 0 0 0 1\n5 0 0 0 0 0 0 1\n6 0 0 0 0 0 0 1\n");
  const Outcome few = run_rubble("eval trajectory " + (scratch / "late.txt") + " " + (scratch / "long.txt"));
  EXPECT_NE(few.err.find("warning: only 4 of 10 poses have a partner in time"), std::string::npos) << few.err;
}

struct BadTrajectory {
  const char* text;
  const char* message;  // with the line, if it has one
};

TEST(EvalTrajectory, NamesFileAndLineOfWhatIsWrong) {
  const ScratchFolder scratch;
  write_file(scratch / "truth.txt", kTruth);
  const BadTrajectory kBad[] = {
      {"", "has no pose"},
      {"1.0 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0\n", "bad.txt:2: not a pose"},
      {"1.0 0 0 0 0 0 0 1\n\n1.1 x 0 0 0 0 0 1\n", "bad.txt:3: not a number"},
      {"1.0 nan 0 0 0 0 0 1\n", "bad.txt:1: not finite"},
      {"1.0 0 0 0 0 0 0 2\n", "bad.txt:1: not a rotation"},
      {"1.1 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n", "bad.txt:2: out of order"},
      {"9.0 0 0 0 0 0 0 1\n", "no time in common"},
      {"1.0,0,0,0,0,0,0,1\n1.1,0,0,0,0,0,0,1\n", "bad.txt:1: the order of the columns is not known"},
      {"t [ns],x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n2,0,0,0,0,0,0,1\n3,0,0,0,0,0,0,1\n", "all stamps at nearly one time"},
      {"1 0 0 0 0 1 0 0 0 0 1 0\n", "has no stamps"},
      {"t,x,y,z\n1,0,0,0\n", "has no orientations"},
      {"1.0 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n", "too few poses"},
      {"1.0 3 0 0 0 0 0 1\n1.1 3 0 0 0 0 0 1\n1.2 3 0 0 0 0 0 1\n", "all at one place"},
  };
  for (const BadTrajectory& bad : kBad) {
    write_file(scratch / "bad.txt", bad.text);
    const Outcome run =
        run_rubble("eval trajectory " + (scratch / "bad.txt") + " " + (scratch / "truth.txt"));
    EXPECT_EQ(run.exit_code, 1) << bad.message;
    EXPECT_NE(run.err.find(bad.message), std::string::npos) << run.err;
  }
  EXPECT_EQ(run_rubble("eval trajectory " + (scratch / "none.txt") + " " + (scratch / "truth.txt"))
                .exit_code,
            1);
}

}  // namespace eval_trajectory_test
}  // namespace rubble::testing
