#include "kernel/geometry/decomposing/solid.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/geometry/distance_transform.h"

namespace rubble {
namespace {

// Places of lines within their columns: a sequence that is even in the plane (Roberts 2018, "R2"), so that
// faces along a row of lines are met in due proportion. Steps in 32 bits.
constexpr double kMostCells = 768;  // along one side
constexpr std::uint32_t kStepX = 3242174889u, kStepY = 2447445414u;

struct Crossing {
  float z;
  int step;  // +1: the line enters the mesh; -1: it leaves it
};

// Where the line at (x, y) along z crosses a triangle that is counter-clockwise seen from outside.
// Returns false if it does not. Edges count for one of the two triangles that share them.
bool cross_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y, Crossing& crossing) {
  const auto side = [x, y](const Vec3& p, const Vec3& q) {
    // In one order of the corners whichever triangle asks, so that both get the same bits.
    const bool ordered = p.x < q.x || (p.x == q.x && p.y < q.y);
    const Vec3 &u = ordered ? p : q, &v = ordered ? q : p;
    const double area = (v.x - u.x) * (y - u.y) - (v.y - u.y) * (x - u.x);
    return (area >= 0) == ordered;
  };
  const bool ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (ab != bc || bc != ca) return false;
  const double wa = (b.x - x) * (c.y - y) - (b.y - y) * (c.x - x);
  const double wb = (c.x - x) * (a.y - y) - (c.y - y) * (a.x - x);
  const double wc = (a.x - x) * (b.y - y) - (a.y - y) * (b.x - x);
  const double sum = wa + wb + wc;
  if (sum == 0) return false;
  crossing = {float((wa * a.z + wb * b.z + wc * c.z) / sum), ab ? -1 : 1};
  return true;
}

// The part of the line at (x, y) within all planes; low > high: none.
void clip_line(const std::vector<HullPlane>& planes, double x, double y, double& low, double& high) {
  for (const HullPlane& plane : planes) {
    const double room = plane.offset - plane.normal.x * x - plane.normal.y * y;
    if (plane.normal.z > 0)
      high = std::min(high, room / plane.normal.z);
    else if (plane.normal.z < 0)
      low = std::max(low, room / plane.normal.z);
    else if (room < 0)
      high = low - 1;
    if (low > high) return;
  }
}

}  // namespace

Solid::Solid(const TriangleMesh& mesh, int resolution) : mesh_(mesh) {
  const Aabb box = mesh.bounds();
  const Vec3 extent = box.max - box.min;
  // As many cells of a long thing as of a cube.
  const double longest = std::max({extent.x, extent.y, extent.z});
  grid_.voxel = std::max(portable::exp(portable::log(extent.x * extent.y * extent.z) / 3) / resolution, longest / kMostCells);
  for (int i = 0; i < 3; ++i) grid_.size[std::size_t(i)] = int(extent[i] / grid_.voxel) + 3;
  const Vec3 span = Vec3(grid_.size[0], grid_.size[1], grid_.size[2]) * grid_.voxel;
  grid_.corner = (box.min + box.max) * 0.5 - span * 0.5;
  state_.assign(grid_.count(), kInside);
  mark_surface(mesh);
  flood_outside();
  note_distances();
  exact_ = is_closed(mesh) && calc_volume_properties(mesh).volume > 0;
  line_x_.resize(columns()), line_y_.resize(columns());
  for (std::size_t i = 0; i < columns(); ++i) {
    const Vec3 corner = grid_.centre(i) - Vec3{0.5, 0.5, 0.5} * grid_.voxel;
    const std::uint32_t n = std::uint32_t(i + 1);
    const double u = exact_ ? (n * kStepX) * 0x1p-32 : 0.5, v = exact_ ? (n * kStepY) * 0x1p-32 : 0.5;
    line_x_[i] = float(corner.x + u * grid_.voxel), line_y_[i] = float(corner.y + v * grid_.voxel);
  }
  exact_ ? cross_mesh(mesh) : cross_cells();
  double length = 0;
  for (const Interval& i : intervals_) length += double(i.high) - double(i.low);
  volume_ = exact_ ? calc_volume_properties(mesh).volume : length * grid_.voxel * grid_.voxel;
}

// Points over each triangle, closer together than half a cell.
void Solid::mark_surface(const TriangleMesh& mesh) {
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const int steps = std::max(1, int(longest / (0.45 * grid_.voxel)) + 1);
    for (int u = 0; u <= steps; ++u)
      for (int v = 0; u + v <= steps; ++v) {
        Cell cell = grid_.find_cell(a + (b - a) * (double(u) / steps) + (c - a) * (double(v) / steps));
        for (std::size_t i = 0; i < 3; ++i) cell[i] = std::clamp(cell[i], 0, grid_.size[i] - 1);
        state_[grid_.index(cell)] = kSurface;
      }
  }
}

void Solid::flood_outside() {
  std::vector<std::size_t> open{0};  // a corner of the grid, whose margin is empty
  state_[0] = kOutside;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    for_each_neighbour(grid_, cell, [&](std::size_t next) {
      if (state_[next] != kInside) return;
      state_[next] = kOutside;
      open.push_back(next);
    });
  }
}

// Of the centres of cells from those of the nearest cells that the mesh passes through, less half a cell.
void Solid::note_distances() {
  std::vector<Cell> seeds;
  for (std::size_t i = 0; i < state_.size(); ++i)
    if (state_[i] == kSurface) seeds.push_back(grid_.cell(i));
  ThreadPool pool(1);
  const std::vector<std::uint32_t> nearest = find_nearest_seeds(grid_, seeds, pool);
  distance_.assign(state_.size(), 0);
  for (std::size_t i = 0; i < state_.size(); ++i) {
    if (state_[i] != kOutside || nearest[i] == kNoSeed) continue;
    const double far = distance(grid_.centre(i), grid_.centre(seeds[nearest[i]]));
    distance_[i] = float(std::max(0.0, far - 0.5 * grid_.voxel));
  }
}

// Crossings with their sign, so that closed bodies may overlap.
void Solid::cross_mesh(const TriangleMesh& mesh) {
  std::vector<std::vector<Crossing>> crossings(columns());
  for (const auto& t : mesh.triangles) {
    const Vec3 p[3] = {Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]), Vec3(mesh.positions[t[2]])};
    Aabb box;
    for (const Vec3& corner : p) box.include(corner);
    const Cell low = grid_.find_cell(box.min), high = grid_.find_cell(box.max);
    for (int j = std::max(0, low[1]); j <= std::min(high[1], grid_.size[1] - 1); ++j)
      for (int i = std::max(0, low[0]); i <= std::min(high[0], grid_.size[0] - 1); ++i) {
        const std::size_t column = grid_.index({i, j, 0});
        Crossing crossing{};
        if (cross_triangle(p[0], p[1], p[2], double(line_x_[column]), double(line_y_[column]), crossing))
          crossings[column].push_back(crossing);
      }
  }
  starts_.assign(1, 0);
  for (std::size_t column = 0; column < columns(); ++column) {
    std::vector<Crossing>& found = crossings[column];
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
      return a.z != b.z ? a.z < b.z : a.step > b.step;
    });
    Intervals inside;
    int depth = 0;
    for (const Crossing& crossing : found) {
      const int before = depth;
      depth += crossing.step;
      if (before <= 0 && depth > 0) inside.push_back({crossing.z, crossing.z});
      if (before > 0 && depth <= 0) inside.back().high = crossing.z;
    }
    close_cavities(int(column), inside);
    intervals_.insert(intervals_.end(), inside.begin(), inside.end());
    starts_.push_back(std::uint32_t(intervals_.size()));
  }
}

// Joins intervals whose gap lies in a cavity.
void Solid::close_cavities(int column, Intervals& intervals) const {
  Intervals joined;
  for (const Interval& next : intervals) {
    bool cavity = false, open = joined.empty();
    if (!open) {
      const auto row = [&](float z) { return std::clamp(grid_.find_cell({0, 0, double(z)})[2], 0, grid_.size[2] - 1); };
      for (int k = row(joined.back().high); k <= row(next.low); ++k) {
        const std::uint8_t state = state_[std::size_t(column) + columns() * std::size_t(k)];
        const double z = grid_.centre(Cell{0, 0, k}).z;
        open = open || state == kOutside;
        cavity = cavity || (state == kInside && z > double(joined.back().high) && z < double(next.low));
      }
    }
    if (!open && cavity)
      joined.back().high = next.high;
    else
      joined.push_back(next);
  }
  intervals = std::move(joined);
}

void Solid::cross_cells() {
  starts_.assign(1, 0);
  for (std::size_t column = 0; column < columns(); ++column) {
    bool inside = false;
    for (int k = 0; k < grid_.size[2]; ++k) {
      const bool is = state_[column + columns() * std::size_t(k)] != kOutside;
      const float z = float(grid_.corner.z + k * grid_.voxel);
      if (is && !inside) intervals_.push_back({z, z});
      if (!is && inside) intervals_.back().high = z;
      inside = is;
    }
    starts_.push_back(std::uint32_t(intervals_.size()));
  }
}

bool Solid::is_deep_inside(const Vec3& point) const {
  const Cell cell = grid_.find_cell(point);
  return grid_.contains(cell) && state_[grid_.index(cell)] == kInside;
}

bool Solid::contains(const Vec3& point) const {
  if (!exact_ || is_deep_inside(point)) return is_deep_inside(point);
  int depth = 0;
  for (const auto& t : mesh_.triangles) {
    const Vec3 a(mesh_.positions[t[0]]), b(mesh_.positions[t[1]]), c(mesh_.positions[t[2]]);
    Crossing crossing{};
    if (std::min({a.x, b.x, c.x}) > point.x || std::max({a.x, b.x, c.x}) < point.x) continue;
    if (cross_triangle(a, b, c, point.x, point.y, crossing) && double(crossing.z) <= point.z) depth += crossing.step;
  }
  return depth > 0;
}

double Solid::largest_distance(std::size_t column, double low, double high) const {
  const double first = (low - grid_.corner.z) / grid_.voxel - 0.5, last = (high - grid_.corner.z) / grid_.voxel - 0.5;
  const int begin = std::max(0, int(std::ceil(first))), end = std::min(grid_.size[2] - 1, int(std::floor(last)));
  float largest = 0;
  for (int k = begin; k <= end; ++k) largest = std::max(largest, distance_[column + columns() * std::size_t(k)]);
  return double(largest);
}

// hulls: ascending, apart from each other.
void Solid::add_line(std::size_t column, const Intervals& hulls, Misfit& sum) const {
  const Interval *solid = begin(column), *last = end(column);
  double shared = 0, whole = 0;
  for (const Interval& hull : hulls) {
    double from = double(hull.low);
    for (const Interval* s = solid; s != last; ++s) {
      const double low = std::max(from, double(s->low)), high = std::min(double(hull.high), double(s->high));
      if (low >= high) continue;
      if (low > from) sum.outside += low - from, sum.gap = std::max(sum.gap, largest_distance(column, from, low));
      shared += high - low;
      from = high;
    }
    if (double(hull.high) > from) {
      sum.outside += double(hull.high) - from;
      sum.gap = std::max(sum.gap, largest_distance(column, from, double(hull.high)));
    }
  }
  for (const Interval* s = solid; s != last; ++s) whole += double(s->high) - double(s->low);
  sum.inside += whole - shared;
}

Misfit Solid::measure(const Hull& hull) const {
  const std::vector<HullPlane> planes = calc_planes(hull);
  Aabb box;
  for (const Vec3& p : hull.points) box.include(p);
  const Cell low = grid_.find_cell(box.min), high = grid_.find_cell(box.max);
  Misfit sum;
  Intervals line(1);
  for (int j = std::max(0, low[1]); j <= std::min(high[1], grid_.size[1] - 1); ++j)
    for (int i = std::max(0, low[0]); i <= std::min(high[0], grid_.size[0] - 1); ++i) {
      const std::size_t column = grid_.index({i, j, 0});
      double from = box.min.z, to = box.max.z;
      clip_line(planes, double(line_x_[column]), double(line_y_[column]), from, to);
      if (from >= to) continue;
      line[0] = {float(from), float(to)};
      add_line(column, line, sum);
    }
  sum.outside *= grid_.voxel * grid_.voxel;
  sum.inside = 0;
  return sum;
}

Misfit Solid::measure(const std::vector<Hull>& hulls) const {
  std::vector<Intervals> lines(columns());
  for (const Hull& hull : hulls) {
    const std::vector<HullPlane> planes = calc_planes(hull);
    Aabb box;
    for (const Vec3& p : hull.points) box.include(p);
    const Cell low = grid_.find_cell(box.min), high = grid_.find_cell(box.max);
    for (int j = std::max(0, low[1]); j <= std::min(high[1], grid_.size[1] - 1); ++j)
      for (int i = std::max(0, low[0]); i <= std::min(high[0], grid_.size[0] - 1); ++i) {
        const std::size_t column = grid_.index({i, j, 0});
        double from = box.min.z, to = box.max.z;
        clip_line(planes, double(line_x_[column]), double(line_y_[column]), from, to);
        if (from < to) lines[column].push_back({float(from), float(to)});
      }
  }
  Misfit sum;
  for (std::size_t column = 0; column < columns(); ++column) {
    Intervals& line = lines[column];
    std::sort(line.begin(), line.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
    Intervals joined;
    for (const Interval& i : line) {
      if (joined.empty() || i.low > joined.back().high)
        joined.push_back(i);
      else
        joined.back().high = std::max(joined.back().high, i.high);
    }
    add_line(column, joined, sum);
  }
  sum.outside *= grid_.voxel * grid_.voxel;
  sum.inside *= grid_.voxel * grid_.voxel;
  return sum;
}

}  // namespace rubble
