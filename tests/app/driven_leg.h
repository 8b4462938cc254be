// The legs that `rubble drive` leaves, run again.
#pragma once

#include <string>

#include "tests/app/program.h"

namespace rubble::testing {

// Expects `rubble run` on FOLDER/out/LEG.lua to give the frames that were seen, hash for hash, at least
// `least` of them; the run's files are in FOLDER/LEG.
void expect_same_frames(const ScratchFolder& folder, const std::string& leg, std::size_t least);

}  // namespace rubble::testing
