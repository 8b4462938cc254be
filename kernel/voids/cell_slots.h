// Numbers some cells of a grid without gaps, so that what is known of these alone takes no room for the others: a bit a
// cell, and for each word of 64 bits how many come before it. Words without a bit are left out, but for a byte each.
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
  CellSlots(std::size_t cells, const IsWanted& is_wanted) : places_(cells / kBits + 1, kLeftOut) {
    for (std::size_t first = 0; first < cells; first += kBits) {
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < kBits && first + i < cells; ++i)
        if (is_wanted(first + i)) bits |= std::uint64_t(1) << i;
      if (bits == 0) continue;
      places_[first / kBits] = 0;
      words_.emplace_back(bits);
    }
    words_.shrink_to_fit();
    place_words();
    count_before();
  }

  // wanted: indices of cells.
  CellSlots(std::size_t cells, const std::vector<std::uint32_t>& wanted) : places_(cells / kBits + 1, kLeftOut) {
    for (const std::uint32_t i : wanted) places_[i / kBits] = 0;
    words_.resize(place_words());
    for (const std::uint32_t i : wanted) words_[find_word(i / kBits)].mark(i % kBits);
    count_before();
  }

  std::size_t count() const { return count_; }  // of cells that have a number

  // The number of a cell, in the order of their indices; kNoSlot: it has none. index: of a cell of the grid.
  std::uint32_t operator[](std::size_t index) const {
    const std::size_t word = index / kBits;
    return places_[word] == kLeftOut ? kNoSlot : words_[find_word(word)].number(index % kBits);
  }

 private:
  static constexpr std::size_t kBits = 64, kGroup = 64;
  static constexpr std::uint8_t kLeftOut = 255;

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
  // Where the words are that are not left out; how many these are.
  std::size_t place_words() {
    std::uint32_t count = 0;
    for (std::size_t word = 0; word < places_.size(); ++word) {
      if (word % kGroup == 0) groups_.push_back(count);
      if (places_[word] != kLeftOut) places_[word] = std::uint8_t(count++ - groups_.back());
    }
    return count;
  }
  void count_before() {
    for (Word& word : words_) {
      word.set_before(count_);
      count_ += word.count();
    }
  }
  // In words_, of one that is not left out.
  std::size_t find_word(std::size_t word) const { return groups_[word / kGroup] + places_[word]; }

  std::vector<std::uint8_t> places_;   // of each word of the grid how many of its group of 64 come before it
  std::vector<std::uint32_t> groups_;  // of each group how many words come before it
  std::vector<Word> words_;            // those that are not left out; a bit for each of 64 cells
  std::size_t count_ = 0;
};

}  // namespace rubble
