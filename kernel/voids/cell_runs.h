// Cells of a grid in ascending order, as runs of consecutive ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace rubble {

struct CellRun {
  std::uint32_t first, count;
};

class CellRuns {
 public:
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = std::uint32_t;
    using difference_type = std::ptrdiff_t;
    using pointer = const std::uint32_t*;
    using reference = std::uint32_t;

    Iterator() = default;
    explicit Iterator(std::vector<CellRun>::const_iterator run) : run_(run) {}
    std::uint32_t operator*() const { return run_->first + offset_; }
    Iterator& operator++() {
      if (++offset_ == run_->count) ++run_, offset_ = 0;
      return *this;
    }
    Iterator operator++(int) {
      Iterator old = *this;
      ++*this;
      return old;
    }
    bool operator==(const Iterator& other) const { return run_ == other.run_ && offset_ == other.offset_; }
    bool operator!=(const Iterator& other) const { return !(*this == other); }

   private:
    std::vector<CellRun>::const_iterator run_;
    std::uint32_t offset_ = 0;
  };

  CellRuns() = default;
  // runs: in any order, none empty, no cell twice.
  explicit CellRuns(std::vector<CellRun> runs) {
    std::sort(runs.begin(), runs.end(), [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    for (const CellRun& run : runs) {
      size_ += run.count;
      if (!runs_.empty() && runs_.back().first + runs_.back().count == run.first)
        runs_.back().count += run.count;
      else
        runs_.push_back(run);
    }
    runs_.shrink_to_fit();
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Iterator begin() const { return Iterator(runs_.begin()); }
  Iterator end() const { return Iterator(runs_.end()); }
  const std::vector<CellRun>& runs() const { return runs_; }
  std::uint32_t front() const { return runs_.front().first; }
  // The n-th cell: for some, not for each in turn.
  std::uint32_t operator[](std::size_t n) const {
    std::size_t run = 0;
    while (n >= runs_[run].count) n -= runs_[run++].count;
    return runs_[run].first + std::uint32_t(n);
  }

 private:
  std::vector<CellRun> runs_;
  std::size_t size_ = 0;
};

}  // namespace rubble
