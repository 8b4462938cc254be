// What solution verification compares: the same work at other steps, and with other numbers of sweeps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/equilibrium/pile_record.h"

namespace rubble {

struct Variant {
  int step_hz = 60;   // steps a second; range: 30 to 1000
  int substeps = 16;  // of the contact solver in a step, one sweep each; range: 1 to 64
};

// Small works, each a pile, a ruin or a robot on a pile; in the order of the tables.
std::vector<std::string> verified_works();
std::string describe_verified_works();

// First the one that everybody uses, then shorter steps, then other numbers of sweeps. Throws InputError for an
// unknown work.
std::vector<Variant> variants_of(const std::string& work);

// "loose@120x16": the key of a record.
std::string name_of(const std::string& work, const Variant& variant);

// Settles or drives it and measures: lengths in m, volumes in m3, times in s, forces as multiples of the mean weight of
// the movable pieces.
Record measure(const std::string& work, std::uint64_t seed, const Variant& variant, int threads);

}  // namespace rubble
