#include "render/lighting/radiance_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/lighting/light_packing.h"

namespace rubble {

namespace {

constexpr float kEnough = 0.25f;  // of the weight of all eight corners, for those that are seen to stand for all

}  // namespace

Vec3f AirGrid::point(std::size_t i) const {
  const auto nx = std::size_t(size[0]), ny = std::size_t(size[1]);
  return {origin.x + cell.x * float(i % nx), origin.y + cell.y * float(i / nx % ny),
          origin.z + cell.z * float(i / (nx * ny))};
}

Vec3f AirGrid::nearest(const Vec3f& point) const {
  Vec3f out = point;
  for (int i = 0; i < 3; ++i)
    out[i] = std::clamp(point[i], origin[i], origin[i] + cell[i] * float(size[std::size_t(i)] - 1));
  return out;
}

Vec3f AirGrid::length() const {
  return {cell.x * float(size[0] - 1), cell.y * float(size[1] - 1), cell.z * float(size[2] - 1)};
}

AirGrid::Corners AirGrid::about(const Vec3f& point) const {
  std::array<std::uint32_t, 3> low{};
  Vec3f part;
  for (int i = 0; i < 3; ++i) {
    const float most = float(size[std::size_t(i)] - 1);
    const float at = std::clamp((point[i] - origin[i]) / cell[i], 0.0f, most);
    low[std::size_t(i)] = std::min(std::uint32_t(at), std::uint32_t(most) - 1);
    part[i] = at - float(low[std::size_t(i)]);
  }
  const auto nx = std::uint32_t(size[0]), ny = std::uint32_t(size[1]);
  Corners out;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t x = k & 1, y = k >> 1 & 1, z = k >> 2;
    out.at[k] = ((low[2] + z) * ny + low[1] + y) * nx + low[0] + x;
    out.weight[k] = (x ? part.x : 1 - part.x) * (y ? part.y : 1 - part.y) * (z ? part.z : 1 - part.z);
  }
  return out;
}

void AirGrid::Corners::keep(std::uint8_t seen, const std::vector<std::uint32_t>& stand_in) {
  if (seen == 255 || stand_in.empty()) return;
  float sum = 0;
  for (std::size_t k = 0; k < 8; ++k)
    if (seen >> k & 1u) sum += weight[k];
  const float share = std::min(sum / kEnough, 1.0f);
  const float of_seen = sum > 0 ? share / sum : 0, of_others = sum < 1 ? (1 - share) / (1 - sum) : 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const bool is_seen = seen >> k & 1u;
    weight[k] *= is_seen ? of_seen : of_others;
    if (!is_seen) at[k] = stand_in[at[k]];
  }
}

std::uint8_t SeenCorners::at(const AirGrid& grid, const Vec3f& point) const {
  if (seen.empty()) return 255;
  std::size_t cell = 0, part = 0, row = 1, parts = 1;
  for (int i = 0; i < 3; ++i) {
    const int last = grid.size[std::size_t(i)] - 2;
    const float at = std::max((point[i] - grid.origin[i]) / grid.cell[i], 0.0f);
    const int low = std::min(int(at), last), within = std::clamp(int((at - float(low)) * float(cuts)), 0, cuts - 1);
    cell += std::size_t(low) * row, part += std::size_t(within) * parts;
    row *= std::size_t(grid.size[std::size_t(i)]), parts *= std::size_t(cuts);
  }
  return seen[cell * parts + part];
}

AirGrid::Corners RadianceGrid::corners(const Vec3f& point, const std::vector<std::uint32_t>& stands_in) const {
  AirGrid::Corners out = grid.about(point);
  out.keep(seen.at(grid, point), stands_in);
  return out;
}

float factor_in_stops(const std::array<float, 8>& luminances, const std::array<float, 8>& weights) {
  constexpr float kLeast = 1.0f / 4096;  // of the brightest: what is darker counts as so bright
  const float most = *std::max_element(luminances.begin(), luminances.end());
  if (most <= 0) return 1;
  float mean = 0, stops = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    mean += weights[k] * luminances[k];
    stops += weights[k] * quick::log2(std::max(luminances[k] / most, kLeast));
  }
  return mean > 0 ? std::min(most * quick::exp2(stops) / mean, 1.0f) : 1.0f;
}

// The first terms; the others are zero.
template <std::size_t terms>
RadianceTerms blend_first(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners) {
  typedef float Four __attribute__((vector_size(16)));
  constexpr std::size_t kFours = (3 * terms + 3) / 4;  // what is too much of the last is still of the terms
  static_assert(sizeof(RadianceTerms) == 12 * kHarmonics && 4 * kFours <= 3 * kHarmonics);
  std::array<Four, kFours> sum{};
  for (std::size_t k = 0; k < 8; ++k) {
    const char* from = reinterpret_cast<const char*>(grid[corners.at[k]].data());
    for (std::size_t i = 0; i < kFours; ++i) {
      Four values;
      std::memcpy(&values, from + i * sizeof values, sizeof values);
      sum[i] += values * corners.weight[k];
    }
  }
  RadianceTerms out{};
  std::memcpy(static_cast<void*>(out.data()), sum.data(), 12 * terms);
  return out;
}

RadianceTerms blend(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners) {
  return blend_first<kHarmonics>(grid, corners);
}

namespace {

float factor_of(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners) {
  std::array<float, 8> luminances{};
  for (std::size_t k = 0; k < 8; ++k) luminances[k] = luminance(grid[corners.at[k]][0]);
  return factor_in_stops(luminances, corners.weight);
}

}  // namespace

RadianceTerms blend_in_stops(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners) {
  RadianceTerms out = blend(grid, corners);
  const float factor = factor_of(grid, corners);
  for (Vec3f& term : out) term *= factor;
  return out;
}

RadianceTerms RadianceGrid::between(const AirGrid::Corners& corners) const {
  RadianceTerms out = blend_in_stops(terms, corners);
  if (ends_of_lamp.empty()) return out;
  const RadianceTerms more = blend(ends_of_lamp, corners);
  for (std::size_t t = 0; t < kHarmonics; ++t) out[t] += more[t];
  return out;
}

// Next to the box what the border's nearest sees; farther away the open surroundings, in which the box with its fog is
// seen as four discs that have the area that it shows.
RadianceTerms RadianceGrid::at(const Vec3f& point) const {
  const Vec3f near = grid.nearest(point);
  RadianceTerms out = between(corners(near, stand_in));
  const float off = norm(point - near);
  if (off <= 0) return out;
  const Vec3f size = grid.length();
  const float part = 4 * off / norm(size), share = 1 / ((1 + part * part) * (1 + part * part));
  for (std::size_t t = 0; t < kHarmonics; ++t) out[t] = out[t] * share + open[t] * (1 - share);
  for (int k = 0; k < 4; ++k) add_disc(point, k, 1 - share, out);
  return out;
}

// Adds what a quarter of the box shows instead of what lies behind it.
void RadianceGrid::add_disc(const Vec3f& point, int quarter, float share, RadianceTerms& out) const {
  const Vec3f size = grid.length();
  const Vec3f side(quarter & 1 ? 0.25f : -0.25f, quarter & 2 ? 0.25f : -0.25f, quarter == 0 || quarter == 3 ? 0.25f : -0.25f);
  const Vec3f middle = grid.origin + Vec3f(size.x * (0.5f + side.x), size.y * (0.5f + side.y), size.z * (0.5f + side.z));
  const Vec3f way = middle - point;
  float enters = 0;  // as a share of the way
  for (int a = 0; a < 3; ++a) {
    const float border = way[a] > 0 ? grid.origin[a] : grid.origin[a] + size[a];
    if (std::fabs(way[a]) > 1e-6f) enters = std::max(enters, std::min((border - point[a]) / way[a], 1.0f));
  }
  const float away = norm(way);
  const Vec3f direction = way * (1 / away);
  const float shown = std::fabs(direction.x) * size.y * size.z + std::fabs(direction.y) * size.z * size.x +
                      std::fabs(direction.z) * size.x * size.y;
  const float disc2 = shown / (4 * portable::kPiF);  // radius squared
  const float e2 = std::max(1 - disc2 / (away * away), 0.0f), edge = std::sqrt(e2);  // cosine of its angle
  // Integrals over the disc of Legendre's polynomials.
  const float disc[kOrders] = {1 - edge, (1 - e2) / 2, edge * (1 - e2) / 2, (1 - e2) * (5 * e2 - 1) / 8};
  const Harmonics y = harmonics_of(direction);
  const RadianceTerms there = between(corners(point + way * enters, stand_in));
  Vec3f instead;
  for (std::size_t t = 0; t < kHarmonics; ++t) instead += (there[t] - open[t]) * y[t];
  for (std::size_t t = 0; t < kHarmonics; ++t)
    out[t] += instead * (2 * portable::kPiF * share * disc[order_of(t)] * y[t]);
}

RadianceTerms RadianceGrid::of_lamp_at(const Vec3f& point) const {
  return of_lamp.empty() || norm(point - grid.nearest(point)) > 0 ? RadianceTerms{} : blend(of_lamp, corners(point, lamp_stand_in));
}

std::array<Vec3f, kOrders> orders_towards(const RadianceTerms& terms, const Vec3f& direction) {
  const Harmonics y = harmonics_of(direction);
  std::array<Vec3f, kOrders> out{};
  for (std::size_t t = 0; t < kHarmonics; ++t) out[order_of(t)] += terms[t] * y[t];
  return out;
}

// The cosine's own terms: pi, 2 pi / 3, pi / 4, 0 (Ramamoorthi and Hanrahan 2001).
Vec3f illuminance_of(const RadianceTerms& terms, const Vec3f& normal) {
  constexpr float kCosine[kOrders] = {3.1415927f, 2.0943951f, 0.7853982f, 0};
  const std::array<Vec3f, kOrders> orders = orders_towards(terms, normal);
  Vec3f sum;
  for (std::size_t l = 0; l < kOrders; ++l) sum += orders[l] * kCosine[l];
  for (int c = 0; c < 3; ++c) sum[c] = std::max(sum[c], 0.0f);
  return sum;
}

// What the cosine asks for is in the first nine terms.
Vec3f illuminance_between(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners, const Vec3f& normal,
                          bool in_stops) {
  return illuminance_of(blend_first<9>(grid, corners), normal) * (in_stops ? factor_of(grid, corners) : 1.0f);
}

}  // namespace rubble
