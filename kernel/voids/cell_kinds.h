// The kind of each cell of a grid, in two bits.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rubble {

enum class CellKind : std::uint8_t { outside, free_void, solid };

class CellKinds {
 public:
  CellKinds() = default;
  explicit CellKinds(std::size_t cells) : size_(cells), words_(cells / kPerWord + 1, kAllVoid) { clear_rest(); }

  std::size_t size() const { return size_; }
  CellKind operator[](std::size_t cell) const {
    return CellKind(__atomic_load_n(&words_[cell / kPerWord], __ATOMIC_RELAXED) >> shift(cell) & kMask);
  }
  // Threads may set different cells at once, or give one cell the same kind.
  void set(std::size_t cell, CellKind kind) {
    std::uint64_t& word = words_[cell / kPerWord];
    const std::uint64_t bits = std::uint64_t(kind) << shift(cell), others = (kMask << shift(cell)) & ~bits;
    const std::uint64_t old = __atomic_load_n(&word, __ATOMIC_RELAXED);
    if (old & others) __atomic_fetch_and(&word, ~others, __ATOMIC_RELAXED);
    if (~old & bits) __atomic_fetch_or(&word, bits, __ATOMIC_RELAXED);
  }
  // Forgets all cells from `cells` on.
  void shrink(std::size_t cells) {
    size_ = cells;
    words_.resize(cells / kPerWord + 1);
    clear_rest();
  }

  std::size_t count(CellKind kind) const {
    std::size_t voids = 0, solids = 0;
    for (const std::uint64_t word : words_) {
      voids += std::bitset<64>(word & kAllVoid).count();
      solids += std::bitset<64>(word & ~kAllVoid).count();
    }
    return kind == CellKind::free_void ? voids : kind == CellKind::solid ? solids : size_ - voids - solids;
  }
  bool operator==(const CellKinds& other) const { return size_ == other.size_ && words_ == other.words_; }

 private:
  static constexpr std::size_t kPerWord = 32;
  static constexpr std::uint64_t kMask = 3, kAllVoid = 0x5555555555555555;

  static unsigned shift(std::size_t cell) { return 2 * unsigned(cell % kPerWord); }
  void clear_rest() { words_.back() &= (std::uint64_t(1) << shift(size_)) - 1; }

  std::size_t size_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace rubble
