#include "kernel/solver/contact_colours.h"

#include <algorithm>

namespace rubble {
namespace {

constexpr std::int32_t kUncoloured = -1;  // the contact of a tower has no colour

}  // namespace

void ContactColours::begin(std::size_t bodies) {
  had_.assign(bodies + 1, 0);
  islands_.begin(bodies);
  contacts_.clear();
}

void ContactColours::add(std::int32_t contact, std::int32_t a, std::int32_t b) {
  contacts_.push_back({contact, a, b, kUncoloured});
  islands_.add(a, b);
}

int ContactColours::choose(const Coloured& contact) const {
  const std::uint64_t had = had_[contact.a] | had_[contact.b];
  return had + 1 == 0 ? kMostColours - 1 : __builtin_ctzll(~had);
}

const std::vector<std::int32_t>& ContactColours::finish() {
  islands_.finish();
  starts_.assign(1, 0);
  for (Coloured& c : contacts_) {
    const Island& island = islands_.of(moving(c));
    if (island.contacts < kTowerWidth * island.height) {
      ++starts_[0];
      continue;
    }
    c.colour = choose(c);
    had_[c.a] |= std::uint64_t(1) << c.colour;
    had_[c.b] |= std::uint64_t(1) << c.colour;
    had_.back() = 0;
    if (std::size_t(c.colour) + 2 > starts_.size()) starts_.resize(std::size_t(c.colour) + 2, 0);
    ++starts_[std::size_t(c.colour) + 1];
  }
  for (std::size_t colour = 1; colour < starts_.size(); ++colour) starts_[colour] += starts_[colour - 1];
  std::int32_t next[kMostColours] = {}, tower = 0;
  std::copy(starts_.begin(), starts_.end() - 1, next);
  sorted_.resize(contacts_.size());
  for (const Coloured& c : contacts_) sorted_[c.colour == kUncoloured ? tower++ : next[c.colour]++] = c.contact;
  return sorted_;
}

}  // namespace rubble
