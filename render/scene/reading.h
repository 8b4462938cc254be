// A reading of a sensor that gives a few numbers (a distance, a pressure, a position on Earth) or a scan.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/scene/range_scan.h"

namespace rubble {

struct Reading {
  int sensor = 0;               // number among the recording's sensors of this sort
  std::int64_t stamp_ns = 0;    // simulation time; unit: ns
  std::vector<double> values;   // as ReadingFormat::columns() says; may be infinite, and NaN where nothing is known
  std::shared_ptr<const RangeScan> scan{};  // of a sensor that scans, and has no values; null: of another
};

}  // namespace rubble
