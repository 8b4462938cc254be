// A drive in a window on a screen of its own, driven by programs of ROS alone.
#pragma once

#include <string>

#include "tests/app/program.h"

namespace rubble::testing {

// Runs `rubble drive` on that mission under Xvfb at 10 steps a second, with these options
// and what the shell makes of `before`; beside it, once it is ready, `beside`. In both, $d is the scratch
// folder; its out/ gets the legs, its stderr what the drive said. Fails the test when one of them fails, or
// after so many seconds.
void drive_in_a_window(const ScratchFolder& scratch, const std::string& before,
                       const std::string& options, const std::string& beside,
                       const std::string& mission = "scripts/small.lua --record", int limit_s = 120);

// That `rubble run` on the two legs gives the frames that were seen, hash for hash, and that the legs
// went as was asked, see check_drive.py. heard: whether $d/live.bag has what was heard meanwhile.
void expect_the_drive_runs_again(const ScratchFolder& scratch, bool heard);

// A mission with a crawler that has a 2-D scanner, beside a few bricks: $d/robot.lua.
void write_robot_mission(const ScratchFolder& scratch);

// That `rubble run` on the two legs of that crawler moves everything with the same bits, that /cmd_vel and /joint_trajectory
// drove it in the first and /joy in the second, and that what could not be followed was said. heard: whether $d/live.bag
// has what was heard meanwhile, see check_robot.py.
void expect_the_robot_runs_again(const ScratchFolder& scratch, bool heard);

}  // namespace rubble::testing
