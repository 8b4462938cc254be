// A grid of probes, each of which says how bright every direction is, to first order in spherical harmonics.
// Internal to render/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/base/portable_math.h"
#include "render/lighting/light_packing.h"

namespace rubble {

// Radiance from direction w: mean + (slope[0] w.x + slope[1] w.y + slope[2] w.z); unit: kcd/m2
struct LightProbe {
  Vec3f mean, slope[3];
  bool inside = false;  // of a piece
  bool known = true;    // or filled in

  void add(const LightProbe& other, float weight) {
    mean += other.mean * weight;
    for (int i = 0; i < 3; ++i) slope[i] += other.slope[i] * weight;
  }
  // Illuminance of a surface of normal n: pi mean + 2/3 pi slope n (Ramamoorthi and Hanrahan 2001).
  Vec3f illuminance(const Vec3f& n) const {
    const Vec3f along = slope[0] * n.x + slope[1] * n.y + slope[2] * n.z;
    return max(mean * portable::kPiF + along * (2 * portable::kPiF / 3), Vec3f());
  }
  bool is_same(const LightProbe& o) const {
    return mean == o.mean && slope[0] == o.slope[0] && slope[1] == o.slope[1] && slope[2] == o.slope[2] &&
           inside == o.inside;
  }
  // dot(n, result) is the strength of that light, for normals near n.
  Vec3f vector(const Vec3f& n) const {
    const Vec3f rise = Vec3f(luminance(slope[0]), luminance(slope[1]), luminance(slope[2])) *
                       (2 * portable::kPiF / 3);
    return n * (luminance(illuminance(n)) - dot(rise, n)) + rise;
  }
};

class ProbeGrid {
 public:
  using Probes = std::vector<LightProbe>;

  // Over a box, in cells of at least 0.4 m, and of so many that there are about 4,000 probes at most. unit: m
  void lay_out(Aabb box);

  std::size_t count() const { return std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]); }
  std::size_t row() const { return std::size_t(size_[0]); }  // probes that follow each other along X
  const Vec3f& cell() const { return cell_; }                // from probe to probe; unit: m
  Vec3f point_of(std::size_t probe) const;
  // The point lies in the grid, or within a cell of it.
  bool covers(const Vec3f& point) const;
  // Of the cell that a point lies in, or of the nearest: its lowest probe.
  std::size_t cell_of(const Vec3f& point) const;

  // Between the eight probes about a point. Those inside pieces hardly count.
  LightProbe sample(const Probes& probes, const Vec3f& point) const;
  // Probes inside pieces get what their neighbours outside have, ring by ring, ever darker.
  Probes fill_inside(Probes probes) const;
  // By the lowest probe of each cell: whether any of its eight is another in `now`.
  std::vector<std::uint8_t> find_changed_cells(const Probes& before, const Probes& now) const;

 private:
  struct Place {
    int low[3];
    float part[3];  // of the way to the next probe; range: 0 to 1
  };
  Place find(const Vec3f& point) const;
  std::size_t probe_at(int x, int y, int z) const { return std::size_t((z * size_[1] + y) * size_[0] + x); }

  Vec3f origin_, cell_;      // of probe (0, 0, 0), and from probe to probe; unit: m
  int size_[3] = {2, 2, 2};  // probes along each axis
};

}  // namespace rubble
