// Seeded noise fields over space, from integer hashes and arithmetic alone: the same bits on every
// machine. The lattice spacing is 1; scale the argument for another size.
#pragma once

#include <cstdint>

#include "kernel/base/math.h"

namespace rubble::generator {

// Unlike fmax and fmin, inline.
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

// Smooth gradient noise (after Perlin 2002); about [-1, 1], mean 0.
double gradient_noise(const Vec3& p, std::uint32_t seed);

// Octaves of gradient noise, each half as large and twice as fine; about [-1, 1].
double fractal_noise(const Vec3& p, int octaves, std::uint32_t seed);

// The same with creases at the zero crossings, as a brittle break has; about [0, 1].
double ridged_noise(const Vec3& p, int octaves, std::uint32_t seed);

// Rounded grains, one at a random place in each lattice cell: 1 on top of a grain, 0 between.
double grain_noise(const Vec3& p, std::uint32_t seed);

// Shallow tilted bowls that meet in sharp ridges, as flakes come off a brittle break: 0 to 1.
double flake_noise(const Vec3& p, std::uint32_t seed);

}  // namespace rubble::generator
