#include "kernel/solver/islands.h"

#include <algorithm>
#include <utility>

namespace rubble {

void Islands::begin(std::size_t bodies) {
  sets_.reset(bodies + 1);
  height_.assign(bodies + 1, 0);
  contacts_.assign(bodies + 1, 0);
}

void Islands::add(std::int32_t a, std::int32_t b) {
  const auto still = std::int32_t(height_.size()) - 1;
  for (const auto& [upper, lower] : {std::pair{a, b}, std::pair{b, a}}) {
    std::int32_t& height = height_[std::size_t(upper)];
    if (upper != still && height == 0) height = height_[std::size_t(lower)] + 1;
  }
  if (a != still && b != still) sets_.join(a, b);
  ++contacts_[std::size_t(a != still ? a : b)];
}

void Islands::finish() {
  islands_.assign(height_.size(), {});
  for (std::size_t body = 0; body + 1 < height_.size(); ++body) {
    Island& island = islands_[std::size_t(sets_.find(std::int32_t(body)))];
    island.contacts += contacts_[body];
    island.height = std::max(island.height, height_[body]);
  }
}

}  // namespace rubble
