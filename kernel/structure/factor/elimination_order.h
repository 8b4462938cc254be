// The order in which the rows of a sparse symmetric matrix are eliminated so that its factor stays small.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// By row, the rows that it shares an entry with; the same pair may occur twice.
using RowNeighbours = std::vector<std::vector<std::int32_t>>;

// Nested dissection (George 1973): planes part the rows by where they are, those that touch the other side
// come last, and each side is parted again. Small sets go by least degree (Tinney and Walker 1967), ties by
// number. places: by row, anywhere; rows that share entries should be near each other.
std::vector<std::int32_t> find_elimination_order(const RowNeighbours& neighbours, const std::vector<Vec3>& places);

}  // namespace rubble
