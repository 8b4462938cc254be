// A drive in a window on a screen of its own, driven by programs of ROS alone.
#pragma once

#include <string>

#include "tests/app/program.h"

namespace rubble::testing {

// Runs `rubble drive scripts/small.lua` under Xvfb at 10 steps a second, recording, with these options
// and what the shell makes of `before`; beside it, once it is ready, `beside`. In both, $d is the scratch
// folder; its out/ gets the legs, its stderr what the drive said. Fails the test when one of them fails.
void drive_in_a_window(const ScratchFolder& scratch, const std::string& before,
                       const std::string& options, const std::string& beside);

// That `rubble run` on the two legs gives the frames that were seen, hash for hash, and that the legs
// went as was asked, see check_drive.py. heard: whether $d/live.bag has what was heard meanwhile.
void expect_the_drive_runs_again(const ScratchFolder& scratch, bool heard);

}  // namespace rubble::testing
