#include "render/lighting/probe_grid.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

constexpr double kMostProbes = 4000;  // about
constexpr double kLeastCell = 0.4;    // unit: m
constexpr float kDimmer = 0.6f;       // a probe inside a piece, against its neighbours outside
constexpr float kTrust = 0.02f;       // weight of such a probe against one outside

}  // namespace

void ProbeGrid::lay_out(Aabb box) {
  box.max.z = std::max(box.max.z, box.min.z + kLeastCell);
  const Vec3 edges = box.max - box.min;
  const double cell = std::max(kLeastCell, quick::cbrt(edges.x * edges.y * edges.z / kMostProbes));
  origin_ = Vec3f(box.min);
  for (int i = 0; i < 3; ++i) {
    size_[i] = std::max(2, int(std::ceil(edges[i] / cell)) + 1);
    cell_[i] = float(edges[i] / (size_[i] - 1));
  }
}

Vec3f ProbeGrid::point_of(std::size_t probe) const {
  const auto nx = std::size_t(size_[0]), ny = std::size_t(size_[1]);
  const Vec3f step(float(probe % nx), float(probe / nx % ny), float(probe / (nx * ny)));
  return origin_ + multiply(cell_, step);
}

bool ProbeGrid::covers(const Vec3f& point) const {
  for (int i = 0; i < 3; ++i) {
    const float at = (point[i] - origin_[i]) / cell_[i];
    if (at < -1 || at > float(size_[i])) return false;
  }
  return true;
}

ProbeGrid::Place ProbeGrid::find(const Vec3f& point) const {
  Place place;
  for (int i = 0; i < 3; ++i) {
    const float most = float(size_[i] - 1);
    const float at = std::clamp((point[i] - origin_[i]) / cell_[i], 0.0f, most);
    place.low[i] = std::min(int(at), size_[i] - 2);
    place.part[i] = at - float(place.low[i]);
  }
  return place;
}

std::size_t ProbeGrid::cell_of(const Vec3f& point) const {
  const Place place = find(point);
  return probe_at(place.low[0], place.low[1], place.low[2]);
}

LightProbe ProbeGrid::sample(const Probes& probes, const Vec3f& point) const {
  const auto [low, part] = find(point);
  LightProbe out;
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const float weight = (k & 1 ? part[0] : 1 - part[0]) * (k & 2 ? part[1] : 1 - part[1]) *
                         (k & 4 ? part[2] : 1 - part[2]);
    if (weight <= 0) continue;
    const LightProbe& probe = probes[probe_at(low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2))];
    const float trust = probe.inside ? weight * kTrust : weight;
    out.add(probe, trust);
    sum += trust;
  }
  LightProbe mean;
  mean.add(out, 1 / sum);
  return mean;
}

ProbeGrid::Probes ProbeGrid::fill_inside(Probes grid) const {
  const std::ptrdiff_t nx = size_[0], ny = size_[1];
  const std::ptrdiff_t steps[6] = {-1, 1, -nx, nx, -nx * ny, nx * ny};
  for (bool changed = true; changed;) {
    changed = false;
    const Probes before = grid;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (before[i].known) continue;
      const int x = int(i) % size_[0], y = int(i) / size_[0] % size_[1];
      const int z = int(i) / (size_[0] * size_[1]);
      const bool there[6] = {x > 0, x + 1 < size_[0], y > 0, y + 1 < size_[1], z > 0, z + 1 < size_[2]};
      LightProbe sum;
      float count = 0;
      for (int k = 0; k < 6; ++k) {
        const auto j = std::size_t(std::ptrdiff_t(i) + steps[k]);
        if (there[k] && before[j].known) sum.add(before[j], 1), count += 1;
      }
      if (count == 0) continue;
      grid[i] = LightProbe();
      grid[i].inside = true;
      grid[i].add(sum, kDimmer / count);
      changed = true;
    }
  }
  return grid;
}

std::vector<std::uint8_t> ProbeGrid::find_changed_cells(const Probes& before, const Probes& now) const {
  std::vector<std::uint8_t> changed(now.size(), 0);
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x) {
        const std::size_t probe = probe_at(x, y, z);
        if (now[probe].is_same(before[probe])) continue;
        for (int k = 0; k < 8; ++k) {
          const int cx = x - (k & 1), cy = y - (k >> 1 & 1), cz = z - (k >> 2);
          if (cx >= 0 && cy >= 0 && cz >= 0) changed[probe_at(cx, cy, cz)] = 1;
        }
      }
  return changed;
}

}  // namespace rubble
