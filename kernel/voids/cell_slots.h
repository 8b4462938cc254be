// Numbers some cells of a grid without gaps, so that what is known of these alone takes no room for the others: a bit a
// cell, and for each word of 64 bits how many come before it. Words without a bit are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rubble {

inline constexpr std::uint32_t kNoSlot = 0xffffffffu;

class CellSlots {
 public:
  CellSlots() = default;

  // cells: of the grid. is_wanted(index): whether a cell gets a number; asked of each in turn.
  template <typename IsWanted>
  CellSlots(std::size_t cells, const IsWanted& is_wanted) : groups_(cells / (kBits * kBits) + 1) {
    for (std::size_t first = 0; first < cells; first += kBits) {
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < kBits && first + i < cells; ++i)
        if (is_wanted(first + i)) bits |= std::uint64_t(1) << i;
      if (bits == 0) continue;
      groups_[first / (kBits * kBits)].mark(first / kBits % kBits);
      words_.emplace_back(bits);
    }
    words_.shrink_to_fit();
    count_before(groups_);
    count_ = count_before(words_);
  }

  // wanted: indices of cells.
  CellSlots(std::size_t cells, const std::vector<std::uint32_t>& wanted) : groups_(cells / (kBits * kBits) + 1) {
    for (const std::uint32_t i : wanted) groups_[i / (kBits * kBits)].mark(i / kBits % kBits);
    words_.resize(count_before(groups_));
    for (const std::uint32_t i : wanted) words_[find_word(i)].mark(i % kBits);
    count_ = count_before(words_);
  }

  std::size_t count() const { return count_; }  // of cells that have a number

  // The number of a cell, in the order of their indices; kNoSlot: it has none. index: of a cell of the grid.
  std::uint32_t operator[](std::size_t index) const {
    const std::uint32_t word = find_word(index);
    return word == kNoSlot ? kNoSlot : words_[word].number(index % kBits);
  }

 private:
  static constexpr std::size_t kBits = 64;

  // All that a question needs, side by side and without padding.
  class Word {
   public:
    Word() = default;
    explicit Word(std::uint64_t bits) : half_{std::uint32_t(bits), std::uint32_t(bits >> 32)} {}

    void mark(std::size_t at) { half_[at / 32] |= std::uint32_t(1) << (at % 32); }
    std::uint32_t count() const { return count_ones(bits()); }
    void set_before(std::size_t before) { before_ = std::uint32_t(before); }
    // How many bits are before that one, in this word and all before; kNoSlot: it is not marked.
    std::uint32_t number(std::size_t at) const {
      const std::uint64_t bit = std::uint64_t(1) << at;
      return bits() & bit ? before_ + count_ones(bits() & (bit - 1)) : kNoSlot;
    }

   private:
    std::uint64_t bits() const { return half_[0] | std::uint64_t(half_[1]) << 32; }

    std::uint32_t half_[2] = {0, 0};
    std::uint32_t before_ = 0;
  };

  // In place, of each two bits, each four and each byte: without an instruction for it compilers call a function.
  static std::uint32_t count_ones(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555;
    word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return std::uint32_t(word * 0x0101010101010101 >> 56);
  }
  // All together.
  static std::size_t count_before(std::vector<Word>& words) {
    std::size_t count = 0;
    for (Word& word : words) {
      word.set_before(count);
      count += word.count();
    }
    return count;
  }
  // In words_.
  std::uint32_t find_word(std::size_t cell) const {
    return groups_[cell / (kBits * kBits)].number(cell / kBits % kBits);
  }

  std::vector<Word> groups_;  // a bit for each of 64 words
  std::vector<Word> words_;   // those that have a bit; a bit for each of 64 cells
  std::size_t count_ = 0;
};

}  // namespace rubble
