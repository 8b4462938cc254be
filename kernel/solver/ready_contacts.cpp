#include "kernel/solver/ready_contacts.h"

#include <algorithm>

namespace rubble {

void ReadyContacts::begin(int kinds, int ranks, std::vector<std::int32_t>& next) {
  ranks_ = ranks;
  count_ = 0;
  kinds_.assign(std::size_t(kinds), {});
  first_.assign(std::size_t(kinds) * std::size_t(ranks), -1);
  next_ = &next;
}

void ReadyContacts::add(int kind, int rank, std::int32_t contact) {
  std::int32_t& first = first_[std::size_t(kind * ranks_ + rank)];
  (*next_)[std::size_t(contact)] = first;
  first = contact;
  Kind& k = kinds_[std::size_t(kind)];
  k.highest = std::max(k.highest, rank);
  ++k.count;
  ++count_;
}

int ReadyContacts::choose(int lanes) const {
  int best = 0, best_score = -1;
  for (int kind = 0; kind < int(kinds_.size()); ++kind) {
    if (kinds_[std::size_t(kind)].count == 0) continue;
    const bool fills = kinds_[std::size_t(kind)].count >= lanes;
    const int score = kinds_[std::size_t(kind)].highest + (fills ? ranks_ : 0);
    if (score > best_score) best_score = score, best = kind;
  }
  return best;
}

std::int32_t ReadyContacts::take(int kind) {
  Kind& k = kinds_[std::size_t(kind)];
  const auto list = [&]() -> std::int32_t& { return first_[std::size_t(kind * ranks_ + k.highest)]; };
  const std::int32_t contact = list();
  list() = (*next_)[std::size_t(contact)];
  --k.count;
  --count_;
  while (k.count > 0 && list() < 0) --k.highest;
  if (k.count == 0) k.highest = 0;
  return contact;
}

}  // namespace rubble
