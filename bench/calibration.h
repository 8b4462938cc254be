// How fast the machine is, so that tables from different machines can be read together: the
// processor time of a fixed amount of work that has nothing to do with this project's code. It is
// the same work in every version, on every machine; figures are those of a release build.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

struct Calibration {
  double one_thread = 0;   // processor time of the work; unit: ms
  double two_threads = 0;  // of the slower of two threads that do it side by side; unit: ms
};

// The best of a few tries each. Takes about a fifth of a second on an idle machine, and 8 MiB.
Calibration calibrate();

// A third each of the time: integers with branches that cannot be foreseen, single-precision lanes
// of four out of the first-level cache, and words all over `memory`. Returns a number that depends
// on every result; memory: of kCalibrationWords, changed.
inline constexpr std::size_t kCalibrationWords = std::size_t(1) << 19;  // 4 MiB
std::uint64_t do_calibration_work(std::vector<std::uint64_t>& memory);

std::string calibration_text(const Calibration& calibration);  // a line for people
// Two columns to append to lines of comma-separated figures, without a leading comma.
std::string calibration_csv_header();
std::string calibration_csv(const Calibration& calibration);

}  // namespace rubble
