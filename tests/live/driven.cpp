#include "tests/live/driven.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/app/driven_leg.h"

namespace rubble::testing {

void drive_in_a_window(const ScratchFolder& scratch, const std::string& before,
                       const std::string& options, const std::string& beside,
                       const std::string& mission, int limit_s) {
  write_file(scratch / "drive.sh", "d='" + scratch.path().string() + R"('
Xvfb -displayfd 3 -screen 0 448x168x24 -nolisten tcp 3>$d/display >/dev/null 2>&1 & screen=$!
master=
trap 'kill $screen $master' EXIT
)" + before + R"(
for i in $(seq 100); do [ -s $d/display ] && break; sleep 0.1; done
export DISPLAY=:$(cat $d/display)
unset SDL_VIDEODRIVER
env -u ROS_IP -u CYCLONEDDS_URI -u ROS_DOMAIN_ID ')" RUBBLE_PROGRAM R"(' drive )" + mission + R"( \
  --size 160x120 --set outputs.rawlog=false --set outputs.stl=false \
  --set trajectory.rate_hz=10 --out $d/out )" + options + R"( >$d/stdout 2>$d/stderr & drive=$!
for i in $(seq 600); do kill -0 $drive || exit 1; grep -q 'drive: ready' $d/stderr && break; sleep 0.1; done
)" + beside + R"(
wait $drive
)");
  ASSERT_EQ(std::system(("cd '" RUBBLE_SOURCE_DIR "' && timeout " + std::to_string(limit_s) + " bash '" +
                         (scratch / "drive.sh") + "'")
                            .c_str()),
            0)
      << read_file(scratch / "stderr") << read_file(scratch / "published");
}

void expect_the_drive_runs_again(const ScratchFolder& scratch, bool heard) {
  expect_same_frames(scratch, "leg_001", 4);
  expect_same_frames(scratch, "leg_002", 4);
  const std::string check = RUBBLE_PYTHON " '" RUBBLE_SOURCE_DIR "/tests/live/check_drive.py' '" +
                            scratch.path().string() + (heard ? "' heard" : "' unheard");
  EXPECT_EQ(std::system(check.c_str()), 0);
  EXPECT_NE(read_file(scratch / "stderr").find("/cmd_vel: what came is no geometry_msgs/Twist"),
            std::string::npos)  // of the one with NaN
      << read_file(scratch / "stderr");
}

void write_robot_mission(const ScratchFolder& scratch) {
  write_file(scratch / "robot.lua", R"(return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 8, spawn_position = { 3, 0, 1 }, spawn_bounds = { 0.8, 0.8, 0.6 },
           mix = { { asset = "brick" } } },
  robots = { rubble.robot.crawler { name = "tank", position = { 0, 0, 0.001 } } },
  lidars = { scan = { model = "utm30lx", rate_hz = 10, noise = false, ride = { robot = "tank" },
                      position = { 0.3, 0, 0.3 }, rpy_deg = { 0, 6, 0 } } },
  imu = { on = true, position = { 0.1, 0, 0.05 } },
  trajectory = { rate_hz = 10 },
  outputs = { simplemap = false, preview = false },
})");
}

void expect_the_robot_runs_again(const ScratchFolder& scratch, bool heard) {
  for (const std::string leg : {"leg_001", "leg_002"}) {
    const Outcome run = run_rubble("run " + (scratch / ("out/" + leg + ".lua")) + " --quiet --out " + (scratch / leg) +
                                   " --set camera.width=32 --set camera.height=24 --set outputs.bag=true");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_GT(read_file(scratch / ("out/" + leg + ".track")).size(), 1000U);
    EXPECT_TRUE(read_file(scratch / ("out/" + leg + ".track")) == read_file(scratch / (leg + "/robots/track.bin"))) << leg;
  }
  const std::string first = read_file(scratch / "out/leg_001.lua"), second = read_file(scratch / "out/leg_002.lua");
  const auto says = [](const std::string& text, const char* what) {
    EXPECT_NE(text.find(what), std::string::npos) << what << "\n" << text.substr(0, text.find("robot_run"));
  };
  says(first, "linear = 0.5,");
  says(first, "angular = 0.4,");
  says(first, "joints = { 0.25 }");
  says(first, "joint_names = { \"front_left_flipper_joint\" }");
  says(second, "linear = 0.5,");
  EXPECT_EQ(second.find("joint_names = { \""), std::string::npos) << "a new leg begins without trajectories";
  const std::string said = read_file(scratch / "stderr");
  says(said, "/cmd_vel: what came is no geometry_msgs/Twist");  // of the one with NaN
  says(said, "/joint_trajectory: what came is no trajectory_msgs/JointTrajectory of finite numbers");
  says(said, "/joint_trajectory: joint_names: the robot has no joint of this name with a motor: expected one of "
             "front_left_flipper_joint, front_right_flipper_joint");
  if (!heard) return;
  const std::string check = RUBBLE_PYTHON " '" RUBBLE_SOURCE_DIR "/tests/live/check_robot.py' '" +
                            scratch.path().string() + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

}  // namespace rubble::testing
