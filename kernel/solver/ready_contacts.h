// Contacts that a thread may solve next, by kind and rank. For sweep_plan.cpp.
//
// Those of a kind may share a batch: they have as many points each. The rank of a contact is the length of the
// longest chain of contacts that must wait for each other from it on: whoever has the highest must not be left
// behind (Hu 1961; Graham 1969: list scheduling).
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

class ReadyContacts {
 public:
  // Ranks are less than `ranks`. next: of each contact, shared by all threads; a contact is in one list.
  void begin(int kinds, int ranks, std::vector<std::int32_t>& next);
  bool empty() const { return count_ == 0; }
  void add(int kind, int rank, std::int32_t contact);
  // The kind of the next batch: one that fills it, if there is one, and of several the one of highest rank.
  int choose(int lanes) const;
  int count(int kind) const { return kinds_[kind].count; }
  // The contact of highest rank; there must be one.
  std::int32_t take(int kind);

 private:
  struct Kind {
    int count = 0, highest = 0;  // no contact has a higher rank
  };

  int ranks_ = 0, count_ = 0;
  std::vector<Kind> kinds_;
  std::vector<std::int32_t> first_;  // of each kind and rank; -1: none
  std::vector<std::int32_t>* next_ = nullptr;
};

}  // namespace rubble
