#include "kernel/structure/factor/elimination_order.h"

#include <algorithm>
#include <set>
#include <utility>

namespace rubble {
namespace {

constexpr std::size_t kWhole = 100;    // rows that are not parted any more; 10 to 200 give equal factors; unit: 1
constexpr double kFirstShare = 0.35;   // of the rows on the near side of the first plane tried; unit: 1
constexpr double kShareStep = 0.05;    // between planes; unit: 1
constexpr int kPlanes = 7;             // tried along each axis; unit: 1
// A row of imbalance between the sides costs this share of a row between them. unit: 1
constexpr double kImbalance = 0.02;

using Rows = std::vector<std::int32_t>;

class Dissection {
 public:
  Dissection(const RowNeighbours& neighbours, const std::vector<Vec3>& places)
      : neighbours_(neighbours), places_(places), side_(places.size(), 0), local_(places.size(), -1) {}

  void part(Rows rows, Rows& order) {
    if (rows.size() <= kWhole) return by_least_degree(rows, order);
    Parts best;
    for (int axis = 0; axis < 3; ++axis) {
      std::sort(rows.begin(), rows.end(), [&](std::int32_t a, std::int32_t b) {
        const double at_a = along(a, axis), at_b = along(b, axis);
        return at_a != at_b ? at_a < at_b : a < b;
      });
      for (int i = 0; i < kPlanes; ++i) {
        try_plane(rows, std::size_t(double(rows.size()) * (kFirstShare + kShareStep * i)), best);
      }
    }
    if (best.near.empty()) return by_least_degree(rows, order);
    part(std::move(best.near), order);
    part(std::move(best.far), order);
    order.insert(order.end(), best.between.begin(), best.between.end());
  }

 private:
  struct Parts {
    Rows near, far, between;
    double cost = 0;
  };

  double along(std::int32_t row, int axis) const {
    const Vec3& at = places_[row];
    return axis == 0 ? at.x : axis == 1 ? at.y : at.z;
  }

  void try_plane(const Rows& rows, std::size_t near, Parts& best) {
    for (std::size_t i = 0; i < rows.size(); ++i) side_[rows[i]] = i < near ? 1 : 2;
    Parts parts;
    for (std::size_t i = 0; i < near; ++i) {
      const Rows& others = neighbours_[rows[i]];
      const bool touches =
          std::any_of(others.begin(), others.end(), [this](std::int32_t other) { return side_[other] == 2; });
      (touches ? parts.between : parts.near).push_back(rows[i]);
    }
    parts.far.assign(rows.begin() + std::ptrdiff_t(near), rows.end());
    for (const std::int32_t row : rows) side_[row] = 0;
    if (parts.near.empty()) return;
    const double between = double(parts.between.size());
    const double uneven = double(parts.near.size()) - double(parts.far.size());
    parts.cost = between * (between + kImbalance * (uneven < 0 ? -uneven : uneven));
    if (best.near.empty() || parts.cost < best.cost) best = std::move(parts);
  }

  // Eliminates the row with the fewest neighbours again and again; its neighbours then all know each other.
  void by_least_degree(const Rows& rows, Rows& order) {
    for (std::size_t i = 0; i < rows.size(); ++i) local_[rows[i]] = std::int32_t(i);
    RowNeighbours left(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const std::int32_t other : neighbours_[rows[i]]) {
        if (local_[other] >= 0) left[i].push_back(local_[other]);
      }
      std::sort(left[i].begin(), left[i].end());
      left[i].erase(std::unique(left[i].begin(), left[i].end()), left[i].end());
    }
    for (const std::int32_t row : rows) local_[row] = -1;
    std::set<std::pair<std::size_t, std::int32_t>> queue;
    for (std::size_t i = 0; i < rows.size(); ++i) queue.insert({left[i].size(), std::int32_t(i)});
    Rows joined;
    while (!queue.empty()) {
      const std::int32_t next = queue.begin()->second;
      queue.erase(queue.begin());
      order.push_back(rows[next]);
      for (const std::int32_t other : left[next]) {
        Rows& theirs = left[other];
        queue.erase({theirs.size(), other});
        joined.clear();
        std::set_union(theirs.begin(), theirs.end(), left[next].begin(), left[next].end(),
                       std::back_inserter(joined));
        theirs.clear();
        for (const std::int32_t i : joined) {
          if (i != other && i != next) theirs.push_back(i);
        }
        queue.insert({theirs.size(), other});
      }
    }
  }

  const RowNeighbours& neighbours_;
  const std::vector<Vec3>& places_;
  std::vector<std::uint8_t> side_;    // of the plane that is tried: 1 near, 2 far; 0: not of the rows
  std::vector<std::int32_t> local_;
};

}  // namespace

std::vector<std::int32_t> find_elimination_order(const RowNeighbours& neighbours, const std::vector<Vec3>& places) {
  Rows all, order;
  for (std::size_t i = 0; i < places.size(); ++i) all.push_back(std::int32_t(i));
  Dissection(neighbours, places).part(std::move(all), order);
  return order;
}

}  // namespace rubble
