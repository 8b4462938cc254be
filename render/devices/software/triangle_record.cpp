#include "render/devices/software/triangle_record.h"

#include <algorithm>

namespace rubble {

namespace {

constexpr int kGrid = TriangleRecord::kGrid;
constexpr int kSmall = 24;  // pixels across, up to which 32 bits hold the edge functions

int floor_pixel(std::int32_t x) { return x >> 8; }
int ceil_pixel(std::int32_t x) { return (x + kGrid - 1) >> 8; }

struct Box {
  int x0, x1, y0, y1;  // pixel centres within, both ends included
};

// E(x, y) = dx (y - py) - dy (x - px) - bias of the edge from corner p, on the grid.
template <typename Int>
struct Edge {
  Int value, step_x, step_y;  // at the first pixel, and from pixel to pixel

  Edge(const TriangleRecord& t, int from, int to, int x, int y) {
    const Int dx = t.x[to] - t.x[from], dy = t.y[to] - t.y[from];
    const bool owns = dy < 0 || (dy == 0 && dx > 0);  // a left or a top edge
    value = dx * (Int(y) * kGrid - t.y[from]) - dy * (Int(x) * kGrid - t.x[from]) - (owns ? 0 : 1);
    step_x = -dy * kGrid;
    step_y = dx * kGrid;
  }
};

void put(const TriangleRecord& t, float value, std::size_t at, const RasterTarget& target) {
  value = std::min(std::max(value, t.least), t.most);
  if (value > target.depth[at]) target.depth[at] = value, target.ids[at] = t.id;
}

void put(const TriangleRecord& t, float value, std::size_t at, const DepthTarget& target) {
  target.depth[at] = std::min(target.depth[at], std::min(std::max(value, t.least), t.most));
}

template <typename Target>
void fill_small(const TriangleRecord& t, const Box& box, const Target& target) {
  Edge<std::int32_t> e0(t, 0, 1, box.x0, box.y0), e1(t, 1, 2, box.x0, box.y0),
      e2(t, 2, 0, box.x0, box.y0);
  for (int y = box.y0; y <= box.y1; ++y) {
    const std::size_t row = std::size_t(y) * std::size_t(target.width);
    const double left = t.c + t.b * y;
    std::int32_t v0 = e0.value, v1 = e1.value, v2 = e2.value;
    for (int x = box.x0; x <= box.x1; ++x) {
      if ((v0 | v1 | v2) >= 0) put(t, float(left + t.a * x), row + std::size_t(x), target);
      v0 += e0.step_x, v1 += e1.step_x, v2 += e2.step_x;
    }
    e0.value += e0.step_y, e1.value += e1.step_y, e2.value += e2.step_y;
  }
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return (a % b != 0 && (a < 0) != (b < 0)) ? q - 1 : q;
}

// Narrows [x0, x1] (columns from the box's left) to where the edge function is not negative.
void clip_span(const Edge<std::int64_t>& e, std::int64_t& x0, std::int64_t& x1) {
  if (e.step_x > 0)
    x0 = std::max(x0, -floor_divide(e.value, e.step_x));
  else if (e.step_x < 0)
    x1 = std::min(x1, floor_divide(e.value, -e.step_x));
  else if (e.value < 0)
    x1 = -1;
}

template <typename Target>
void fill_large(const TriangleRecord& t, const Box& box, const Target& target) {
  Edge<std::int64_t> edges[3] = {{t, 0, 1, box.x0, box.y0},
                                 {t, 1, 2, box.x0, box.y0},
                                 {t, 2, 0, box.x0, box.y0}};
  for (int y = box.y0; y <= box.y1; ++y) {
    std::int64_t x0 = 0, x1 = box.x1 - box.x0;
    for (Edge<std::int64_t>& e : edges) {
      clip_span(e, x0, x1);
      e.value += e.step_y;
    }
    const std::size_t row = std::size_t(y) * std::size_t(target.width);
    const double left = t.c + t.b * y;
    const int first = box.x0 + int(x0), last = box.x0 + int(x1);
    for (int x = first; x <= last; ++x)
      put(t, float(left + t.a * x), row + std::size_t(x), target);
  }
}

template <typename Target>
void fill(const TriangleRecord& t, const Target& target) {
  const std::int32_t low_x = std::min(t.x[0], std::min(t.x[1], t.x[2]));
  const std::int32_t high_x = std::max(t.x[0], std::max(t.x[1], t.x[2]));
  const std::int32_t low_y = std::min(t.y[0], std::min(t.y[1], t.y[2]));
  const std::int32_t high_y = std::max(t.y[0], std::max(t.y[1], t.y[2]));
  const Box box{std::max(ceil_pixel(low_x), 0), std::min(floor_pixel(high_x), target.width - 1),
                std::max(ceil_pixel(low_y), target.first_row),
                std::min(floor_pixel(high_y), target.last_row - 1)};
  if (box.x0 > box.x1 || box.y0 > box.y1) return;
  if (high_x - low_x < kSmall * kGrid && high_y - low_y < kSmall * kGrid)
    fill_small(t, box, target);
  else
    fill_large(t, box, target);
}

}  // namespace

void fill_triangle(const TriangleRecord& t, const RasterTarget& target) { fill(t, target); }
void fill_triangle(const TriangleRecord& t, const DepthTarget& target) { fill(t, target); }

}  // namespace rubble
