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
constexpr int kTile = 8;            // columns along each side of a tile, which share a choice of planes
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

// The planes that bound a hull on some line along z through a rectangle: few of those of a round hull. Empty: no line
// through it meets the hull. What they give is what all planes give, to the last bit.
class PlanesOfTile {
 public:
  PlanesOfTile(const std::vector<HullPlane>& planes, const Aabb& hull) : all_(planes), hull_(hull) {
    const double x = std::max(std::fabs(hull.min.x), std::fabs(hull.max.x)), y = std::max(std::fabs(hull.min.y), std::fabs(hull.max.y));
    for (const HullPlane& plane : planes) {
      const double z = std::fabs(plane.normal.z), sum = std::fabs(plane.offset) + std::fabs(plane.normal.x) * 2 * x + std::fabs(plane.normal.y) * 2 * y;
      slacks_.push_back(kSlack * (z > 0 ? sum / z : sum));
    }
    ranges_.resize(planes.size());
  }

  void find(double x0, double x1, double y0, double y1, std::vector<HullPlane>& near) {
    near.clear();
    double low = hull_.min.z, high = hull_.max.z;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const HullPlane& plane = all_[i];
      const double ax = plane.normal.x * x0, bx = plane.normal.x * x1, ay = plane.normal.y * y0, by = plane.normal.y * y1;
      double least = plane.offset - std::max(ax, bx) - std::max(ay, by), most = plane.offset - std::min(ax, bx) - std::min(ay, by);
      if (plane.normal.z > 0) {
        least = least / plane.normal.z - slacks_[i], most = most / plane.normal.z + slacks_[i];
        high = std::min(high, most);
      } else if (plane.normal.z < 0) {
        std::swap(least, most);
        least = least / plane.normal.z - slacks_[i], most = most / plane.normal.z + slacks_[i];
        low = std::max(low, least);
      } else if (most < -slacks_[i]) {
        return;
      }
      ranges_[i] = {least, most};
    }
    if (low > high) return;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const double z = all_[i].normal.z;
      if (z > 0 ? ranges_[i].least <= high : z < 0 ? ranges_[i].most >= low : ranges_[i].least < slacks_[i]) near.push_back(all_[i]);
    }
    if (near.empty()) near.push_back(all_.front());
  }

 private:
  static constexpr double kSlack = 1e-14;  // of a height: more than its rounding
  struct Range {
    double least, most;  // of the heights of a plane over the rectangle
  };
  const std::vector<HullPlane>& all_;
  Aabb hull_;
  std::vector<double> slacks_;
  std::vector<Range> ranges_;
};

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
  most_distance_.assign(columns(), 0);
  for (std::size_t i = 0; i < distance_.size(); ++i) {
    float& most = most_distance_[i % columns()];
    most = std::max(most, distance_[i]);
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

// Or `least`, where it is larger.
double Solid::largest_distance(std::size_t column, double low, double high, double least) const {
  if (double(most_distance_[column]) <= least) return least;
  const double first = (low - grid_.corner.z) / grid_.voxel - 0.5, last = (high - grid_.corner.z) / grid_.voxel - 0.5;
  const int begin = std::max(0, int(std::ceil(first))), end = std::min(grid_.size[2] - 1, int(std::floor(last)));
  float largest = 0;
  for (int k = begin; k <= end; ++k) largest = std::max(largest, distance_[column + columns() * std::size_t(k)]);
  return std::max(double(largest), least);
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
      if (low > from) sum.outside += low - from, sum.gap = largest_distance(column, from, low, sum.gap);
      shared += high - low;
      from = high;
    }
    if (double(hull.high) > from) {
      sum.outside += double(hull.high) - from;
      sum.gap = largest_distance(column, from, double(hull.high), sum.gap);
    }
  }
  for (const Interval* s = solid; s != last; ++s) whole += double(s->high) - double(s->low);
  sum.inside += whole - shared;
}

// visit: what is done with the part of each column's line within the hull, row by row.
template <class Visit>
void Solid::for_each_line(const Hull& hull, const Visit& visit) const {
  const std::vector<HullPlane> planes = calc_planes(hull);
  Aabb box;
  for (const Vec3& p : hull.points) box.include(p);
  Cell low = grid_.find_cell(box.min), high = grid_.find_cell(box.max);
  for (std::size_t k = 0; k < 2; ++k) low[k] = std::max(0, low[k]), high[k] = std::min(high[k], grid_.size[k] - 1);
  PlanesOfTile planes_of_tile(planes, box);
  std::vector<std::vector<HullPlane>> tiles(std::size_t(std::max(0, high[0] - low[0])) / kTile + 1);
  for (int j = low[1]; j <= high[1]; ++j) {
    if ((j - low[1]) % kTile == 0) {
      for (std::size_t t = 0; t < tiles.size(); ++t) {
        const double x = grid_.corner.x + (low[0] + int(t) * kTile) * grid_.voxel, y = grid_.corner.y + j * grid_.voxel;
        const double margin = 0.01 * grid_.voxel, width = kTile * grid_.voxel + margin;
        planes_of_tile.find(x - margin, x + width, y - margin, y + width, tiles[t]);
      }
    }
    for (int i = low[0]; i <= high[0]; ++i) {
      const std::vector<HullPlane>& tile = tiles[std::size_t((i - low[0]) / kTile)];
      if (tile.empty()) continue;
      const std::size_t column = grid_.index({i, j, 0});
      double from = box.min.z, to = box.max.z;
      clip_line(tile, double(line_x_[column]), double(line_y_[column]), from, to);
      if (from < to) visit(column, Interval{float(from), float(to)});
    }
  }
}

Misfit Solid::measure(const Hull& hull) const {
  Misfit sum;
  Intervals line(1);
  for_each_line(hull, [&](std::size_t column, const Interval& part) {
    line[0] = part;
    add_line(column, line, sum);
  });
  sum.outside *= grid_.voxel * grid_.voxel;
  sum.inside = 0;
  return sum;
}

Misfit Solid::measure(const std::vector<Hull>& hulls) const {
  std::vector<Intervals> lines(columns());
  for (const Hull& hull : hulls)
    for_each_line(hull, [&](std::size_t column, const Interval& part) { lines[column].push_back(part); });
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
