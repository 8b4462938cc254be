#include "assets/generator/noise.h"

#include <cmath>

namespace rubble::generator {
namespace {

std::uint32_t hash_cell(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9E3779B1u;
  for (const int c : {x, y, z}) {
    h = (h ^ static_cast<std::uint32_t>(c)) * 0x85EBCA6Bu;
    h ^= h >> 15;
  }
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

double corner_gradient(const Lattice& c, int i, int j, int k, std::uint32_t seed) {
  const std::uint32_t h = hash_cell(c.x + i, c.y + j, c.z + k, seed);
  const Vec3 gradient{2 * part(h, 0) - 1, 2 * part(h, 1) - 1, 2 * part(h, 2) - 1};
  return dot(gradient, c.f - Vec3(i, j, k));
}

// The least of `value(offset, hash)` over the random points of a cell and those around it, one to a
// cell; offset: from p to the point.
template <typename Value>
double least_in_cells(const Vec3& p, std::uint32_t seed, Value value) {
  const Lattice c(p);
  double least = 1e9;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const std::uint32_t h = hash_cell(c.x + i, c.y + j, c.z + k, seed);
        const Vec3 d = Vec3(i + part(h, 0), j + part(h, 1), k + part(h, 2)) - c.f;
        least = std::fmin(least, value(d, h));
      }
    }
  }
  return least;
}

}  // namespace

double gradient_noise(const Vec3& p, std::uint32_t seed) {
  const Lattice c(p);
  const Vec3 t{fade(c.f.x), fade(c.f.y), fade(c.f.z)};
  double plane[2];
  for (int k = 0; k < 2; ++k) {
    const double front =
        mix(corner_gradient(c, 0, 0, k, seed), corner_gradient(c, 1, 0, k, seed), t.x);
    const double back =
        mix(corner_gradient(c, 0, 1, k, seed), corner_gradient(c, 1, 1, k, seed), t.x);
    plane[k] = mix(front, back, t.y);
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
  return std::fmax(0.0, 1 - nearest / 0.5);
}

double flake_noise(const Vec3& p, std::uint32_t seed) {
  const double nearest = least_in_cells(p, seed, [](const Vec3& d, std::uint32_t hash) {
    const Vec3 tilt{part(hash, 1) - 0.5, part(hash, 2) - 0.5, part(hash, 0) - 0.5};
    return dot(d, d) + 1.4 * dot(tilt, d);
  });
  return std::fmin(1.0, std::fmax(0.0, 1.2 * nearest + 0.4));
}

}  // namespace rubble::generator
