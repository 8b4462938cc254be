#include "kernel/voids/void_path.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

#include "kernel/voids/ways_from.h"

namespace rubble {
namespace {

constexpr std::uint8_t kUnknown = 255;  // of a cell's step back
constexpr int kHere = 13;               // the step (0, 0, 0)

Cell decode_step(int step) { return {step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1}; }

double step_length(int step) {
  const Cell d = decode_step(step);
  return std::sqrt(double(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
}

Cell add(const Cell& a, const Cell& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

std::size_t find_inside(const VoidSpace& space, const Vec3& p) {
  const Cell cell = space.grid.find_cell(p);
  if (!space.grid.contains(cell)) throw std::invalid_argument("find_path: outside of the grid");
  return space.grid.index(cell);
}

// Clearance changes by at most the distance walked, so between two points it is nowhere below this.
double leg_clearance(double a, double b, double length) { return (a + b - length) / 2; }

class AStar {
 public:
  AStar(const VoidSpace& space, std::size_t start, std::size_t goal, double radius)
      : space_(space), start_(start), goal_(space.grid.cell(goal)), radius_(radius) {
    length_.assign(space.grid.count(), std::numeric_limits<float>::infinity());
    back_.assign(space.grid.count(), kUnknown);
  }

  // Cells from start to goal; empty when there is no way.
  std::vector<std::size_t> run() {
    if (!(space_.clearance[start_] >= radius_)) return {};
    length_[start_] = 0;
    back_[start_] = kHere;
    front_.push({calc_rest(start_), start_});
    const std::size_t goal = space_.grid.index(goal_);
    while (!front_.empty()) {
      const auto [estimate, i] = front_.top();
      front_.pop();
      if (i == goal) return walk_back(goal);
      if (estimate > double(length_[i]) + calc_rest(i) + 1e-4) continue;
      expand(i);
    }
    return {};
  }

 private:
  using Item = std::pair<double, std::size_t>;

  // In cells; never more than the way along 26 neighbours.
  double calc_rest(std::size_t i) const {
    const Cell c = space_.grid.cell(i);
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) square += double(goal_[k] - c[k]) * (goal_[k] - c[k]);
    return std::sqrt(square);
  }

  void expand(std::size_t i) {
    const Cell cell = space_.grid.cell(i);
    for (int step = 0; step < 27; ++step) {
      const Cell next = add(cell, decode_step(step));
      if (step == kHere || !space_.grid.contains(next)) continue;
      const std::size_t k = space_.grid.index(next);
      const double walked = step_length(step);
      if (leg_clearance(space_.clearance[i], space_.clearance[k], walked * space_.grid.voxel) <
          radius_)
        continue;
      const float length = length_[i] + float(walked);
      if (length >= length_[k]) continue;
      length_[k] = length;
      back_[k] = std::uint8_t(26 - step);
      front_.push({double(length) + calc_rest(k), k});
    }
  }

  std::vector<std::size_t> walk_back(std::size_t i) const {
    std::vector<std::size_t> cells{i};
    while (back_[i] != kHere) {
      i = space_.grid.index(add(space_.grid.cell(i), decode_step(back_[i])));
      cells.push_back(i);
    }
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

  const VoidSpace& space_;
  const std::size_t start_;
  const Cell goal_;
  const double radius_;
  std::vector<float> length_;
  std::vector<std::uint8_t> back_;
  std::priority_queue<Item, std::vector<Item>, std::greater<Item>> front_;
};

// A point's clearance is at least that of its cell's centre less the distance to it.
double bound_clearance(const VoidSpace& space, const Vec3& p) {
  const Cell cell = space.grid.find_cell(p);
  if (!space.grid.contains(cell)) return 0;
  return space.clearance[space.grid.index(cell)] - distance(p, space.grid.centre(cell));
}

// The smallest clearance along a leg as far as the bound can tell, or 0 once it is below `radius`.
double trace_leg(const VoidSpace& space, const Vec3& a, const Vec3& b, double radius) {
  const double length = distance(a, b);
  double smallest = std::numeric_limits<double>::infinity();
  const double smallest_step = 0.1 * space.grid.voxel;
  for (double at = 0;;) {
    const Vec3 p = length > 0 ? a + (b - a) * (at / length) : a;
    const double clearance = bound_clearance(space, p);
    if (clearance < radius + smallest_step) return 0;
    smallest = std::min(smallest, clearance);
    if (at >= length) return smallest;
    at = std::min(length, at + (clearance - radius));
  }
}

// Leaves out every corner that a straight leg can do without.
std::vector<Vec3> pull_tight(const VoidSpace& space, const std::vector<Vec3>& points,
                             double radius) {
  std::vector<Vec3> result{points.front()};
  for (std::size_t at = 0; at + 1 < points.size();) {
    std::size_t reach = at + 1, step = 1;
    while (reach + step < points.size() &&
           trace_leg(space, points[at], points[reach + step], radius) > 0) {
      reach += step;
      step *= 2;
    }
    for (; step >= 1; step /= 2) {
      if (reach + step < points.size() &&
          trace_leg(space, points[at], points[reach + step], radius) > 0)
        reach += step;
    }
    result.push_back(points[reach]);
    at = reach;
  }
  return result;
}

// The largest smallest clearance over all ways from start to goal, and the cell where it is.
std::pair<double, std::size_t> find_widest(const VoidSpace& space, std::size_t start,
                                           std::size_t goal) {
  using Item = std::pair<float, std::size_t>;
  std::vector<float> radius(space.grid.count(), -1);
  std::vector<std::uint32_t> narrowest(space.grid.count(), 0);
  std::priority_queue<Item> front;
  radius[start] = space.clearance[start];
  narrowest[start] = std::uint32_t(start);
  front.push({radius[start], start});
  while (!front.empty()) {
    const auto [width, i] = front.top();
    front.pop();
    if (i == goal) break;
    if (width < radius[i]) continue;
    for_each_neighbour(space.grid, i, [&, wide = width, from = i](std::size_t k) {
      if (space.kind[k] == CellKind::solid) return;
      const float here = std::min(wide, space.clearance[k]);
      if (here <= radius[k]) return;
      radius[k] = here;
      narrowest[k] = here < wide ? std::uint32_t(k) : narrowest[from];
      front.push({here, k});
    });
  }
  return {std::max(0.0f, radius[goal]), narrowest[goal]};
}

void measure(const VoidSpace& space, FoundPath& path) {
  path.narrowest_radius = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < path.points.size(); ++k) {
    const double length = distance(path.points[k], path.points[k + 1]);
    path.length += length;
    const int samples = std::max(1, int(length / space.grid.voxel));
    for (int s = 0; s <= samples; ++s) {
      const Vec3 p = path.points[k] + (path.points[k + 1] - path.points[k]) * (double(s) / samples);
      const std::size_t i = space.grid.index(space.grid.find_cell(p));
      if (space.clearance[i] >= path.narrowest_radius) continue;
      path.narrowest_radius = space.clearance[i];
      path.narrowest = p;
    }
  }
}

}  // namespace

FoundPath find_path(const VoidSpace& space, const Vec3& start, const Vec3& goal, double radius) {
  const std::size_t from = find_inside(space, start), to = find_inside(space, goal);
  FoundPath path;
  const std::vector<std::size_t> cells = AStar(space, from, to, radius).run();
  if (cells.empty()) {
    const auto [width, cell] = find_widest(space, from, to);
    path.narrowest_radius = width;
    path.narrowest = space.grid.centre(cell);
    return path;
  }
  path.found = true;
  std::vector<Vec3> points;
  for (const std::size_t i : cells) points.push_back(space.grid.centre(i));
  if (points.size() == 1) points.push_back(points.front());
  path.points = pull_tight(space, points, radius);
  measure(space, path);
  return path;
}

std::vector<float> calc_ways_through(const VoidSpace& space, const Vec3& from, double radius) {
  const auto slot_of = [&](std::size_t i) {
    return space.clearance[i] >= float(radius) ? std::uint32_t(i) : kNoSlot;
  };
  const auto start = std::uint32_t(find_inside(space, from));
  std::vector<std::uint32_t> starts;
  if (slot_of(start) != kNoSlot) starts.push_back(start);
  const std::vector<double> cells = calc_ways_from(space.grid, starts, space.grid.count(), slot_of);
  std::vector<float> ways(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) ways[i] = float(cells[i] * space.grid.voxel);
  return ways;
}

NearestPlace find_nearest_place(const VoidSpace& space, const Vec3& point, double radius,
                                double reach) {
  const VoxelGrid& grid = space.grid;
  const Cell low = grid.find_cell(point - Vec3{reach, reach, reach});
  const Cell high = grid.find_cell(point + Vec3{reach, reach, reach});
  NearestPlace best;
  double nearest = reach;
  for (int z = std::max(0, low[2]); z <= std::min(grid.size[2] - 1, high[2]); ++z)
    for (int y = std::max(0, low[1]); y <= std::min(grid.size[1] - 1, high[1]); ++y)
      for (int x = std::max(0, low[0]); x <= std::min(grid.size[0] - 1, high[0]); ++x) {
        const std::size_t i = grid.index({x, y, z});
        const double d = distance(point, grid.centre(i));
        if (space.kind[i] == CellKind::solid || space.clearance[i] < radius || d > nearest)
          continue;
        if (best.found && d == nearest) continue;
        nearest = d;
        best = {true, grid.centre(i)};
      }
  if (!best.found) best.position = point;
  return best;
}

}  // namespace rubble
