// Recorded accelerations of the ground, as the archives of strong motion publish them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

struct Accelerogram {
  std::vector<double> values;  // unit: m/s2
  double step = 0;             // time between two values; unit: s
  double peak = 0;             // largest magnitude; unit: m/s2
  std::string format;          // what it was read as: "PEER AT2, in g"
  std::vector<std::string> notes;
};

// For a file that does not say it.
struct AccelerogramOptions {
  std::optional<double> step{};  // unit: s
  std::string unit;              // "g", "gal", "cm/s2", "m/s2", "mg"; empty: as the file says
};

// Lines before the values of a file of PEER, ESM or K-NET; 0: it is none.
std::size_t accelerogram_head_lines(std::string_view text);

// Reads
//   PEER AT2: `NPTS, DT` behind or before their values; g, unless the third line has another unit
//   ESM (ITACA): lines `KEY: value` with SAMPLING_INTERVAL_S, NDATA, UNITS and DATA_TYPE
//   K-NET, KiK-net: 17 lines with `Sampling Freq(Hz)` and `Scale Factor`; their mean is removed
//   one column of numbers with a step and a unit; or two, whose first line names t and the acceleration
//   with its unit: `t [s], a [g]`
// Throws InputError with `path` and line: velocities or displacements, another number of values than the
// head says, no unit, no step, a word that is no number.
Accelerogram parse_accelerogram(std::string_view text, const std::string& path, const AccelerogramOptions& options = {});

}  // namespace rubble
