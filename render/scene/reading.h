// A reading of a sensor that gives a few numbers: a distance, a pressure, a position on Earth.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

struct Reading {
  int sensor = 0;               // number among the recording's sensors of this sort
  std::int64_t stamp_ns = 0;    // simulation time; unit: ns
  std::vector<double> values;   // as ReadingFormat::columns() says; may be infinite, and NaN where nothing is known
};

}  // namespace rubble
