#include "render/passes/antialias.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace rubble {

namespace {

constexpr int kFarthestEnd = 10;      // how far a stair is followed; unit: pixel
constexpr int kLeastContrast = 12;    // of luma, 0 to 255
constexpr float kDepthEdge = 0.006f;  // bend of depth, as a share of it
constexpr int kRowsAJob = 8;

class Smoother {
 public:
  Smoother(const std::uint8_t* rgba, const float* depth, int width, int height, std::uint8_t* rgb)
      : rgba_(rgba), depth_(depth), width_(width), height_(height), rgb_(rgb) {}

  void row(int y) const {
    const bool inner = y > 0 && y + 1 < height_;
    for (int x = 0; x < width_; ++x) {
      const std::ptrdiff_t i = std::ptrdiff_t(y) * width_ + x;
      for (int c = 0; c < 3; ++c) rgb_[i * 3 + c] = rgba_[i * 4 + c];
      if (inner && x > 0 && x + 1 < width_ && depth_edge(i)) smooth(x, y, i);
    }
  }

 private:
  // Depth values are linear over a plane, so a bend or jump is where the mean of two opposite
  // neighbours differs from the middle.
  bool depth_edge(std::ptrdiff_t i) const {
    const float v = depth_[i];
    const float limit = std::max(v, std::max(depth_[i - 1], depth_[i + 1])) * kDepthEdge;
    return std::fabs(depth_[i - 1] + depth_[i + 1] - 2 * v) > limit ||
           std::fabs(depth_[i - width_] + depth_[i + width_] - 2 * v) >
               std::max(v, std::max(depth_[i - width_], depth_[i + width_])) * kDepthEdge;
  }

  int luma(std::ptrdiff_t i) const {
    const std::uint8_t* p = rgba_ + i * 4;
    return (77 * p[0] + 150 * p[1] + 29 * p[2]) >> 8;
  }

  // Steps along the edge from i until the mean across it leaves `mean` by more than `limit`.
  int find_end(std::ptrdiff_t i, std::ptrdiff_t across, std::ptrdiff_t along, int room, int mean2,
               int limit2, int& difference) const {
    for (int n = 1; n <= kFarthestEnd; ++n) {
      if (n > room) return n;
      i += along;
      difference = luma(i) + luma(i + across) - mean2;
      if (std::abs(difference) >= limit2) return n;
    }
    return kFarthestEnd + 1;
  }

  void smooth(int x, int y, std::ptrdiff_t i) const {
    const int m = luma(i), n = luma(i - width_), s = luma(i + width_);
    const int w = luma(i - 1), e = luma(i + 1);
    const int range = std::max({m, n, s, w, e}) - std::min({m, n, s, w, e});
    if (range < kLeastContrast) return;
    const bool level = std::abs(n + s - 2 * m) >= std::abs(w + e - 2 * m);
    // Which neighbour lies across the edge, and which way the edge runs.
    const int back = level ? n : w, front = level ? s : e;
    const bool forward = std::abs(front - m) > std::abs(back - m);
    const std::ptrdiff_t step = level ? width_ : 1, along = level ? 1 : width_;
    const std::ptrdiff_t across = forward ? step : -step;
    const int other = forward ? front : back;
    const int mean2 = m + other, limit2 = std::max(2, std::abs(m - other) / 2);
    const int place = level ? x : y, last = (level ? width_ : height_) - 1;
    int before = 0, after = 0;
    const int to_before = find_end(i, across, -along, place, mean2, limit2, before);
    const int to_after = find_end(i, across, along, last - place, mean2, limit2, after);
    const bool nearer_before = to_before < to_after;
    const int nearest = nearer_before ? to_before : to_after;
    const int difference = nearer_before ? before : after;
    float share = 0;
    // Only the side of the stair that the nearer end belongs to is moved.
    if ((2 * m - mean2 < 0) != (difference < 0))
      share = std::max(0.0f, 0.5f - float(nearest) / float(to_before + to_after));
    // A lone pixel that stands out from all around it.
    const int around = (2 * (n + s + w + e) - 8 * m) / 8;
    const float lone = std::min(1.0f, float(std::abs(around)) / float(range));
    share = std::max(share, lone * lone * 0.35f);
    const std::uint8_t* a = rgba_ + i * 4;
    const std::uint8_t* b = rgba_ + (i + across) * 4;
    for (int c = 0; c < 3; ++c)
      rgb_[i * 3 + c] = std::uint8_t(float(a[c]) + (float(b[c]) - float(a[c])) * share + 0.5f);
  }

  const std::uint8_t* rgba_;
  const float* depth_;
  int width_, height_;
  std::uint8_t* rgb_;
};

}  // namespace

void smooth_edges(const std::vector<std::uint8_t>& rgba, const std::vector<float>& depth_values,
                  int width, int height, ThreadPool& pool, std::vector<std::uint8_t>& rgb) {
  rgb.resize(std::size_t(width) * std::size_t(height) * 3);
  const Smoother smoother(rgba.data(), depth_values.data(), width, height, rgb.data());
  pool.run(height, kRowsAJob, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) smoother.row(y);
  });
}

void copy_colours(const std::vector<std::uint8_t>& rgba, std::vector<std::uint8_t>& rgb) {
  rgb.resize(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) std::copy_n(&rgba[4 * i], 3, &rgb[3 * i]);
}

}  // namespace rubble
