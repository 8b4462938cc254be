#include "assets/generator/noise.h"

#include <cmath>

namespace rubble::generator {
namespace {

// The hash of a cell, coordinate by coordinate: begin, x, y, z, end. Cells of a row share the first ones.
std::uint32_t begin_hash(std::uint32_t seed) { return seed * 0x9E3779B1u; }
std::uint32_t add_to_hash(std::uint32_t h, int c) {
  h = (h ^ static_cast<std::uint32_t>(c)) * 0x85EBCA6Bu;
  return h ^ (h >> 15);
}
std::uint32_t end_hash(std::uint32_t h) {
  h *= 0xC2B2AE35u;
  return h ^ (h >> 16);
}

// Ten bits of the hash as a number in [0, 1).
double part(std::uint32_t hash, int which) { return ((hash >> (10 * which)) & 1023u) / 1024.0; }

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double mix(double a, double b, double t) { return a + (b - a) * t; }

struct Lattice {
  int x, y, z;
  Vec3 f;  // position within the cell, [0, 1)

  explicit Lattice(const Vec3& p)
      : x(static_cast<int>(std::floor(p.x))),
        y(static_cast<int>(std::floor(p.y))),
        z(static_cast<int>(std::floor(p.z))),
        f(p - Vec3(x, y, z)) {}
};

double corner_gradient(const Lattice& c, int i, int j, int k, std::uint32_t h) {
  const Vec3 gradient{2 * part(h, 0) - 1, 2 * part(h, 1) - 1, 2 * part(h, 2) - 1};
  return dot(gradient, c.f - Vec3(i, j, k));
}

// The least of `value(offset, hash)` over the random points of a cell and those around it, one to a
// cell; offset: from p to the point.
template <typename Value>
double least_in_cells(const Vec3& p, std::uint32_t seed, Value value) {
  const Lattice c(p);
  const std::uint32_t start = begin_hash(seed);
  double least = 1e9;
  for (int i = -1; i <= 1; ++i) {
    const std::uint32_t in_x = add_to_hash(start, c.x + i);
    for (int j = -1; j <= 1; ++j) {
      const std::uint32_t in_y = add_to_hash(in_x, c.y + j);
      for (int k = -1; k <= 1; ++k) {
        const std::uint32_t h = end_hash(add_to_hash(in_y, c.z + k));
        const Vec3 d = Vec3(i + part(h, 0), j + part(h, 1), k + part(h, 2)) - c.f;
        least = smaller(least, value(d, h));
      }
    }
  }
  return least;
}

}  // namespace

double gradient_noise(const Vec3& p, std::uint32_t seed) {
  const Lattice c(p);
  const Vec3 t{fade(c.f.x), fade(c.f.y), fade(c.f.z)};
  const std::uint32_t start = begin_hash(seed);
  double at[2][2][2];  // x, y, z
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t in_x = add_to_hash(start, c.x + i);
    for (int j = 0; j < 2; ++j) {
      const std::uint32_t in_y = add_to_hash(in_x, c.y + j);
      for (int k = 0; k < 2; ++k) {
        at[i][j][k] = corner_gradient(c, i, j, k, end_hash(add_to_hash(in_y, c.z + k)));
      }
    }
  }
  double plane[2];
  for (int k = 0; k < 2; ++k) {
    plane[k] = mix(mix(at[0][0][k], at[1][0][k], t.x), mix(at[0][1][k], at[1][1][k], t.x), t.y);
  }
  return 1.5 * mix(plane[0], plane[1], t.z);
}

double fractal_noise(const Vec3& p, int octaves, std::uint32_t seed) {
  double sum = 0, weight = 1, total = 0;
  Vec3 q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * gradient_noise(q, seed + static_cast<std::uint32_t>(i));
    total += weight;
    weight *= 0.5;
    q *= 2.03;  // not 2: lattice planes of the octaves must not coincide
  }
  return sum / total;
}

double ridged_noise(const Vec3& p, int octaves, std::uint32_t seed) {
  double sum = 0, weight = 1, total = 0;
  Vec3 q = p;
  for (int i = 0; i < octaves; ++i) {
    const double n = gradient_noise(q, seed + static_cast<std::uint32_t>(i));
    sum += weight * (n < 0 ? -n : n);
    total += weight;
    weight *= 0.5;
    q *= 2.03;
  }
  return sum / total;
}

double grain_noise(const Vec3& p, std::uint32_t seed) {
  const double nearest =
      least_in_cells(p, seed, [](const Vec3& d, std::uint32_t) { return dot(d, d); });
  return larger(0.0, 1 - nearest / 0.5);
}

double flake_noise(const Vec3& p, std::uint32_t seed) {
  const double nearest = least_in_cells(p, seed, [](const Vec3& d, std::uint32_t hash) {
    const Vec3 tilt{part(hash, 1) - 0.5, part(hash, 2) - 0.5, part(hash, 0) - 0.5};
    return dot(d, d) + 1.4 * dot(tilt, d);
  });
  return smaller(1.0, larger(0.0, 1.2 * nearest + 0.4));
}

}  // namespace rubble::generator
