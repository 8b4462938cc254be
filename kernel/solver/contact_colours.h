// The order in which a sweep comes to contacts: by colour in piles, bottom up in towers.
//
// Contacts of one colour share no moving body, so they can be solved together. Each gets, bottom up, the first colour that
// neither of its bodies has had (greedy edge colouring). So what carries is solved before what is carried, by and large,
// and no chain of contacts that wait for each other has more of them than there are colours: about as many as the body
// with most contacts has. Strictly bottom up, chains climb through the whole pile: 146 contacts where 27 colours
// suffice. Then sixteen lanes times eight threads find too little to do at once, and batches have four contacts.
//
// Colours gain nothing in a single column, where each piece waits for the one below, and they cost rest: loads climb from
// brick to brick in a sweep that goes bottom up, and by two bricks in one that takes every other joint first. Thirty
// bricks drift by 2 to 3 mm instead of 1 before they sleep. So an island (what touches, also through others) with few
// contacts for its height stays bottom up. Walls and stacks of two bricks a course drift less by colours.
//
// The order depends on the contacts alone, not on threads.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/solver/islands.h"

namespace rubble {

class ContactColours {
 public:
  // Bodies have numbers less than this; `bodies` itself does not move.
  void begin(std::size_t bodies);
  // Bottom up. contact: any index, given back by finish().
  void add(std::int32_t contact, std::int32_t a, std::int32_t b);
  // The contacts of towers, bottom up, then the others, colour by colour, and bottom up within each.
  const std::vector<std::int32_t>& finish();

  int count() const { return int(starts_.size()) - 1; }  // of colours, after finish()
  // More contacts of one body share the last colour. Their order stays; they wait for each other.
  static constexpr int kMostColours = 64;
  // An island with fewer contacts per piece of its height is a tower: a column of boxes has 1, a stack of two a course 4.
  static constexpr int kTowerWidth = 2;

 private:
  struct Coloured {
    std::int32_t contact, a, b, colour;
  };
  std::int32_t moving(const Coloured& c) const { return std::size_t(c.a) + 1 < had_.size() ? c.a : c.b; }
  int choose(const Coloured& contact) const;

  std::vector<std::uint64_t> had_;     // colours of each body so far, by bit; what does not move has none
  Islands islands_;
  std::vector<Coloured> contacts_;     // bottom up
  std::vector<std::int32_t> starts_;   // of each colour in sorted_; the end
  std::vector<std::int32_t> sorted_;
};

}  // namespace rubble
