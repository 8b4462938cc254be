// The lowest of some parabolas along a line of cells, in whole numbers (Felzenszwalb and
// Huttenlocher 2012, "Distance transforms of sampled functions").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rubble {

// The parabolas that are lowest somewhere along one line.
class LowerEnvelope {
 public:
  // length: of the line, in cells
  explicit LowerEnvelope(int length) : vertex_(std::size_t(length)), start_(std::size_t(length)) {}

  void clear() { count_ = 0; }

  // height: squared distance of the seed from the line. Vertices come in ascending order.
  void add(int vertex, std::int64_t height) {
    std::int64_t start = 0;
    while (count_ > 0) {
      start = find_start(vertex_[count_ - 1], vertex, height);
      if (start > start_[count_ - 1]) break;
      --count_;
      start = 0;
    }
    vertex_[count_] = {vertex, height};
    start_[count_++] = start;
  }

  // Calls visit(position, vertex) for positions 0 to length - 1.
  template <typename Visit>
  void for_each(int length, Visit&& visit) const {
    std::size_t at = 0;
    for (int i = 0; i < length; ++i) {
      while (at + 1 < count_ && start_[at + 1] <= i) ++at;
      visit(i, vertex_[at].position);
    }
  }
  bool empty() const { return count_ == 0; }

 private:
  struct Parabola {
    int position;
    std::int64_t height;
  };

  // The first whole position where the later parabola is lower than the earlier one.
  static std::int64_t find_start(const Parabola& a, int vertex, std::int64_t height) {
    const std::int64_t p = a.position, q = vertex;
    const std::int64_t above = (q * q + height) - (p * p + a.height);
    const std::int64_t width = 2 * (q - p);
    const std::int64_t floor = above >= 0 ? above / width : -((-above + width - 1) / width);
    return floor < 0 ? 0 : floor + 1;
  }

  std::vector<Parabola> vertex_;
  std::vector<std::int64_t> start_;
  std::size_t count_ = 0;
};

}  // namespace rubble
