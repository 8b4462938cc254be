// Numbers some cells of a grid without gaps, so that what is known of these alone takes no room for
// the others: a bit a cell, and for each word of these how many come before it.
#pragma once

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
      : words_(cells / kBits + 1) {
    for (std::size_t i = 0; i < cells; ++i)
      if (is_wanted(i)) mark(i);
    count_before();
  }

  // wanted: indices of cells, each once.
  CellSlots(std::size_t cells, const std::vector<std::uint32_t>& wanted)
      : words_(cells / kBits + 1) {
    for (const std::uint32_t i : wanted) mark(i);
    count_before();
  }

  std::size_t count() const { return count_; }  // of cells that have a number

  // The number of a cell, in the order of their indices; kNoSlot: it has none. index: of a cell of
  // the grid.
  std::uint32_t operator[](std::size_t index) const {
    const Word& word = words_[index / kBits];
    const std::uint64_t bit = std::uint64_t(1) << (index % kBits);
    if (!(word.bits() & bit)) return kNoSlot;
    return word.before + count_ones(word.bits() & (bit - 1));
  }

 private:
  static constexpr std::size_t kBits = 64;

  // All that a question needs, side by side and without padding.
  struct Word {
    std::uint32_t half[2] = {0, 0};
    std::uint32_t before = 0;  // numbers of the words before

    std::uint64_t bits() const { return half[0] | std::uint64_t(half[1]) << 32; }
  };

  // In place, of each two bits, each four and each byte: without an instruction for it compilers call a function.
  static std::uint32_t count_ones(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555;
    word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return std::uint32_t(word * 0x0101010101010101 >> 56);
  }
  void mark(std::size_t i) { words_[i / kBits].half[i % kBits / 32] |= std::uint32_t(1) << (i % 32); }
  void count_before() {
    for (Word& word : words_) {
      word.before = std::uint32_t(count_);
      count_ += count_ones(word.bits());
    }
  }

  std::vector<Word> words_;
  std::size_t count_ = 0;
};

}  // namespace rubble
