// A settling run as text: a line of figures for machines, a table and the worst pieces for people.
#pragma once

#include <string>

#include "bench/settle_run.h"

namespace rubble {

// The columns, in order, without a line end.
std::string csv_header();
// One line of them. Speeds and depths as in their names; settled is 0 or 1.
std::string csv_line(const SettleRun& run);

// Two columns, a figure a line.
std::string table_text(const SettleRun& run);

// The `count` deepest overlaps, the pieces that still move and those that drift most, with types
// and masses.
std::string worst_text(const SettleRun& run, int count);

std::string name_of(Schedule schedule);

}  // namespace rubble
