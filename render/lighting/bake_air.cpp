#include "render/lighting/bake_air.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/light_packing.h"

namespace rubble {

namespace {

constexpr int kRays = 64;

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

struct SkyRay {
  Vec3f direction;
  Vec3f radiance;  // of the sky there; unit: kcd/m2
};

// All over the sphere.
std::vector<SkyRay> sky_rays(const LightSet& light) {
  std::vector<SkyRay> out;
  for (int i = 0; i < kRays; ++i) {
    const double z = 1 - (2 * i + 1.0) / kRays, turn = i * 0.6180339887498949;
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
    const double r = std::sqrt(1 - z * z);
    const Vec3f w(float(r * a.cos), float(r * a.sin), float(z));
    out.push_back({w, light.sky.radiance(w)});
  }
  return out;
}

struct AirBaker : AirBakeInput {
  std::vector<SkyRay> sky;

  AirLight bake() const;
  bool air_radiance(const Vec3f& point, Vec3f& mean) const;
  void add_lights(const Vec3f& point, AirLight& air, std::size_t at) const;
  void keep_light_out(AirLight& air, const std::vector<std::uint8_t>& known) const;
};

// False where the point lies inside a piece.
bool AirBaker::air_radiance(const Vec3f& point, Vec3f& mean) const {
  Vec3f sum;
  int inside = 0;
  for (const SkyRay& ray : sky) {
    const RayScene::Hit hit = rays.cast(point, ray.direction, 0, kLightReach);
    if (hit.triangle == RayScene::kNone)
      sum += ray.radiance;
    else if (hit.back)
      ++inside;
    else
      sum += radiosity(hit.triangle);
  }
  if (inside > kRays / 4) return false;
  mean = sum * (1.0f / kRays);
  return true;
}

// The lights themselves: how they are scattered depends on where one looks from.
void AirBaker::add_lights(const Vec3f& point, AirLight& air, std::size_t at) const {
  for (std::size_t i = 0; i < light.lights.size(); ++i) {
    const LightModel::Sample sample = light.lights[i].at(point);
    if (!rays.blocked(point, sample.to_light, 0, std::min(sample.distance * 0.999f, kLightReach)))
      air.direct[i * air.radiance.size() + at] = sample.illuminance;
  }
}

// Makes grid point `to` of every kind of light that of `from`, in grids as they were before.
struct AirCopy {
  explicit AirCopy(const AirLight& air) : radiance(air.radiance), direct(air.direct) {}
  void copy(std::size_t from, std::size_t to, AirLight& air) const {
    air.radiance[to] = radiance[from];
    for (std::size_t first = 0; first < direct.size(); first += radiance.size())
      air.direct[first + to] = direct[first + from];
  }
  // If it were scattered evenly; unit: kcd/m2
  float brightness(std::size_t i) const {
    float sum = luminance(radiance[i]);
    for (std::size_t first = 0; first < direct.size(); first += radiance.size())
      sum += luminance(direct[first + i]) / (4 * portable::kPiF);
    return sum;
  }
  std::vector<Vec3f> radiance, direct;
};

// Points inside pieces take the mean of their neighbours outside, ring by ring.
void fill_inside(AirLight& air, std::vector<std::uint8_t>& known) {
  const auto [nx, ny, nz] = air.size;
  const std::ptrdiff_t steps[6] = {-1, 1, -nx, nx, -nx * ny, nx * ny};
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<std::uint8_t> before = known;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (before[i]) continue;
      const int x = int(i) % nx, y = int(i) / nx % ny, z = int(i) / (nx * ny);
      const bool there[6] = {x > 0, x + 1 < nx, y > 0, y + 1 < ny, z > 0, z + 1 < nz};
      const auto mean = [&](std::vector<Vec3f>& grid, std::size_t first) {
        Vec3f sum;
        float count = 0;
        for (int k = 0; k < 6; ++k) {
          const std::size_t j = std::size_t(std::ptrdiff_t(i) + steps[k]);
          if (there[k] && before[j]) sum += grid[first + j], count += 1;
        }
        if (count > 0) grid[first + i] = sum * (1 / count);
        return count > 0;
      };
      if (!mean(air.radiance, 0)) continue;
      for (std::size_t first = 0; first < air.direct.size(); first += known.size())
        mean(air.direct, first);
      known[i] = 1, changed = true;
    }
  }
}

// Between two points on either side of a slab, light would be taken from both: sunlight would glow
// in the void beneath. So a point takes the light of the darkest neighbour that it does not see.
void AirBaker::keep_light_out(AirLight& air, const std::vector<std::uint8_t>& known) const {
  const AirCopy before(air);
  const auto [nx, ny, nz] = air.size;
  const auto index = [nx = nx, ny = ny](int x, int y, int z) {
    return std::size_t((z * ny + y) * nx + x);
  };
  const auto darken = [&, nx = nx, ny = ny, nz = nz](int x, int y, int z) {
    const std::size_t i = index(x, y, z);
    float least = before.brightness(i);
    for (int k = 0; k < 27; ++k) {
      const int a = k % 3 - 1, b = k / 3 % 3 - 1, c = k / 9 - 1;
      const int u = x + a, v = y + b, w = z + c;
      if (u < 0 || v < 0 || w < 0 || u >= nx || v >= ny || w >= nz) continue;
      const std::size_t j = index(u, v, w);
      if (!known[j] || before.brightness(j) >= 0.7f * least) continue;
      const Vec3f step = times(air.cell, Vec3f(float(a), float(b), float(c)));
      const Vec3f from = air.origin + times(air.cell, Vec3f(float(x), float(y), float(z)));
      const float length = norm(step);
      if (!rays.blocked(from, step * (1 / length), 0, length)) continue;
      least = before.brightness(j), before.copy(j, i, air);
    }
  };
  parallel_for(std::size_t(ny * nz), threads, [&, nx = nx, ny = ny](std::size_t row) {
    for (int x = 0; x < nx; ++x) darken(x, int(row) % ny, int(row) / ny);
  });
}

AirLight AirBaker::bake() const {
  constexpr double kMargin = 1.5, kCell = 0.4;  // unit: m
  constexpr int kMost = 48;                     // points along an axis
  Aabb box = scene.bounds;
  if (box.empty()) box.include({0, 0, 1});
  AirLight air;
  const Vec3 low = box.min - Vec3(kMargin, kMargin, 0), high = box.max + Vec3(1, 1, 1) * kMargin;
  air.origin = Vec3f(float(low.x), float(low.y), std::max(float(low.z), 0.05f));
  for (int i = 0; i < 3; ++i) {
    const float length = std::max(float(high[i]) - air.origin[i], 0.1f);
    air.size[std::size_t(i)] = std::clamp(int(std::ceil(length / kCell)) + 1, 2, kMost);
    air.cell[i] = length / float(air.size[std::size_t(i)] - 1);
  }
  const auto [nx, ny, nz] = air.size;
  air.radiance.resize(std::size_t(nx) * std::size_t(ny) * std::size_t(nz));
  air.direct.resize(air.radiance.size() * light.lights.size());
  std::vector<std::uint8_t> known(air.radiance.size());
  parallel_for(std::size_t(ny * nz), threads, [&, row = nx, rows = ny](std::size_t job) {
    for (int x = 0; x < row; ++x) {
      const std::size_t i = job * std::size_t(row) + std::size_t(x);
      const Vec3f step(float(x), float(int(job) % rows), float(int(job) / rows));
      const Vec3f point = air.origin + times(air.cell, step);
      known[i] = air_radiance(point, air.radiance[i]);
      if (known[i]) add_lights(point, air, i);
    }
  });
  keep_light_out(air, known);
  fill_inside(air, known);
  return air;
}

}  // namespace

AirLight bake_air(const AirBakeInput& input) { return AirBaker{input, sky_rays(input.light)}.bake(); }

Vec3f AirLight::nearest(const Vec3f& point) const {
  Vec3f out = point;
  for (int i = 0; i < 3; ++i)
    out[i] = std::clamp(point[i], origin[i], origin[i] + cell[i] * float(size[std::size_t(i)] - 1));
  return out;
}

Vec3f AirLight::at(const Vec3f* grid, const Vec3f& point) const {
  if (radiance.size() == 1) return *grid;
  int low[3];
  float part[3];
  for (int i = 0; i < 3; ++i) {
    const float most = float(size[std::size_t(i)] - 1);
    const float at = std::clamp((point[i] - origin[i]) / cell[i], 0.0f, most);
    low[i] = std::min(int(at), int(most) - 1);
    part[i] = at - float(low[i]);
  }
  const auto [nx, ny, nz] = size;
  const Vec3f* corner = grid + (low[2] * ny + low[1]) * nx + low[0];
  const auto row = [&](const Vec3f* p) { return p[0] + (p[1] - p[0]) * part[0]; };
  const auto layer = [&](const Vec3f* p) {
    const Vec3f a = row(p);
    return a + (row(p + size[0]) - a) * part[1];
  };
  const Vec3f bottom = layer(corner);
  return bottom + (layer(corner + size[0] * size[1]) - bottom) * part[2];
}

}  // namespace rubble
