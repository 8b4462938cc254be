// Numbers some cells of a grid without gaps, so that what is known of these alone takes no room for
// the others: a bit a cell, and for each word of these how many come before it.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rubble {

inline constexpr std::uint32_t kNoSlot = 0xffffffffu;

class CellSlots {
 public:
  CellSlots() = default;

  // cells: of the grid. is_wanted(index): whether a cell gets a number.
  template <typename IsWanted>
  CellSlots(std::size_t cells, const IsWanted& is_wanted)
      : words_(cells / kBits + 1), before_(words_.size()) {
    for (std::size_t i = 0; i < cells; ++i)
      if (is_wanted(i)) words_[i / kBits] |= std::uint64_t(1) << (i % kBits);
    count_before();
  }

  // wanted: indices of cells, each once.
  CellSlots(std::size_t cells, const std::vector<std::uint32_t>& wanted)
      : words_(cells / kBits + 1), before_(words_.size()) {
    for (const std::uint32_t i : wanted) words_[i / kBits] |= std::uint64_t(1) << (i % kBits);
    count_before();
  }

  std::size_t count() const { return count_; }  // of cells that have a number

  // The number of a cell, in the order of their indices; kNoSlot: it has none. index: of a cell of
  // the grid.
  std::uint32_t operator[](std::size_t index) const {
    const std::uint64_t word = words_[index / kBits], bit = std::uint64_t(1) << (index % kBits);
    if (!(word & bit)) return kNoSlot;
    return before_[index / kBits] + std::uint32_t(std::bitset<kBits>(word & (bit - 1)).count());
  }

 private:
  static constexpr std::size_t kBits = 64;

  void count_before() {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      before_[w] = std::uint32_t(count_);
      count_ += std::bitset<kBits>(words_[w]).count();
    }
  }

  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
  std::size_t count_ = 0;
};

}  // namespace rubble
