#include "assets/generator/solid.h"

#include <cmath>

#include "assets/generator/noise.h"
#include "assets/generator/polytope.h"

namespace rubble::generator {
namespace {

constexpr double kDeepest = 0.035;      // what wear removes at most; unit: m
constexpr double kScar = 0.0026;        // an edge that receded farther was chipped; unit: m
constexpr double kHollowRound = 0.009;  // of the inner edges of hollows; unit: m

// What every face shares at one point, worked out when first asked for: noise is what costs.
class Spot {
 public:
  Spot(const Solid& solid, const Vec3& p)
      : wear_(solid.wear), seed_(solid.seed), p_(p), in_chips_(p * (1 / solid.wear.chip_size)) {}

  const Vec3& position() const { return p_; }
  // Beyond this far below the highest face another has no part in the surface. unit: m
  double reach() const {
    return wear_.edge_round + wear_.edge_chip + wear_.fracture_depth + wear_.cast_depth;
  }

  double roughness() {  // of a break, 0 to 1
    if (roughness_ < 0) roughness_ = calc_roughness();
    return roughness_;
  }
  double dent(const Face& face) {  // unit: m
    if (face.rough || is_fracture(face.surface)) return wear_.fracture_depth * roughness();
    if (cast_dent_ < 0) cast_dent_ = calc_cast_dent();
    return cast_dent_;
  }
  double edge_width() {  // unit: m
    if (edge_width_ < 0) {
      const double chips = std::fmax(0.0, 1.4 * fractal_noise(in_chips_, 2, seed_ + 41));
      edge_width_ = wear_.edge_round + wear_.edge_chip * std::fmin(1.0, chips * chips);
    }
    return edge_width_;
  }

 private:
  static bool is_fracture(Surface s) {
    return s == Surface::concrete_fracture || s == Surface::brick_fracture;
  }
  double calc_roughness() const {
    const double waves = ridged_noise(p_ * (1 / wear_.fracture_size), 3, seed_);
    const double flakes = flake_noise(p_ * (1.7 / wear_.fracture_size), seed_ + 51);
    const double grains = grain_noise(p_ * (1 / wear_.grain_size), seed_ + 11);
    const double mixed = 0.45 * std::fmin(1.0, 1.6 * waves) + 0.35 * flakes + 0.2 * (1 - grains);
    return std::fmin(1.0, std::fmax(0.0, 2.1 * mixed - 0.45));
  }
  double calc_cast_dent() const {
    const double sway = std::fmax(0.0, 0.5 + 0.5 * gradient_noise(in_chips_, seed_ + 21));
    const double pits = std::fmax(0.0, fractal_noise(in_chips_ * 2.5, 2, seed_ + 31) - 0.25);
    return wear_.cast_depth * std::fmin(1.0, 0.3 * sway + 2 * pits);
  }

  const Wear& wear_;
  std::uint32_t seed_;
  Vec3 p_, in_chips_;
  double roughness_ = -1, cast_dent_ = -1, edge_width_ = -1;
};

double plain_value(const Face& face, const Vec3& p) {
  const double along = dot(face.normal, p);
  if (!face.round) return along - face.offset;
  return std::sqrt(std::fmax(0.0, dot(p, p) - along * along)) - face.offset;
}

double plain_value(const Cell& cell, const Vec3& p) {
  double value = -1e9;
  for (const Face& face : cell) value = std::fmax(value, plain_value(face, p));
  return value;
}

// The larger of two, blended over the width k: a rounded edge (quadratic, after Quilez).
double smooth_max(double a, double b, double k) {
  const double h = std::fmax(0.0, k - std::fabs(a - b)) / k;
  return std::fmax(a, b) + 0.25 * h * h * k;
}

Surface broken(Surface surface) {
  if (surface == Surface::concrete_cast) return Surface::concrete_fracture;
  return surface == Surface::brick ? Surface::brick_fracture : surface;
}

// The edge between two surfaces: rounded and, where it receded far, chipped. A chip's scar is a
// break, and rough.
FieldSample join(const FieldSample& a, const FieldSample& b, Spot& spot) {
  FieldSample result = a.value >= b.value ? a : b;
  if (std::fabs(a.value - b.value) > spot.reach()) return result;
  const double sharp = result.value;
  result.value = smooth_max(a.value, b.value, spot.edge_width());
  const double receded = result.value - sharp;
  if (receded > kScar) {
    result.value += std::fmin(receded - kScar, 0.5 * kScar) * spot.roughness();
    result.surface = broken(result.surface);
  }
  return result;
}

FieldSample rough_value(const Cell& cell, Spot& spot) {
  const double highest = plain_value(cell, spot.position());
  FieldSample result{-1e9, Surface::concrete_cast};
  for (const Face& face : cell) {
    const double plain = plain_value(face, spot.position());
    if (plain < highest - spot.reach()) continue;
    result = join(result, {plain + spot.dent(face), face.surface}, spot);
  }
  return result;
}

// A hollow is smooth inside: its walls were cast, and its edges are worn where it meets a face.
FieldSample cut_hollow(const FieldSample& solid, const Cell& hollow, Spot& spot) {
  double inside = -1e9, highest = -1e9;
  const Face* nearest = &hollow.front();
  for (const Face& face : hollow) {
    const double value = plain_value(face, spot.position());
    if (value > highest) highest = value, nearest = &face;
    inside = inside < -1e8 ? value : smooth_max(inside, value, kHollowRound);
  }
  if (-inside < solid.value - spot.reach()) return solid;
  return join(solid, {-inside + spot.dent(*nearest), nearest->surface}, spot);
}

}  // namespace

const char* surface_name(Surface surface) {
  static const char* const kNames[kSurfaceCount] = {
      "concrete_cast", "concrete_fracture", "brick",  "brick_fracture", "cinder_block",
      "rebar",         "steel_galvanised",  "timber", "plaster"};
  return kNames[static_cast<int>(surface)];
}

Cell box_cell(const Vec3& min, const Vec3& max, Surface surface) {
  return {{{1, 0, 0}, max.x, surface}, {{-1, 0, 0}, -min.x, surface},
          {{0, 1, 0}, max.y, surface}, {{0, -1, 0}, -min.y, surface},
          {{0, 0, 1}, max.z, surface}, {{0, 0, -1}, -min.z, surface}};
}

FieldSample sample(const Solid& solid, const Vec3& p, double band) {
  double plain = 1e9;
  for (const Cell& cell : solid.cells) plain = std::fmin(plain, plain_value(cell, p));
  for (const Cell& hollow : solid.hollows) plain = std::fmax(plain, -plain_value(hollow, p));
  // Roughness only ever removes, so outside it is needed on the way to the surface alone.
  if (plain > band || plain < -band - kDeepest) return {plain, Surface::concrete_cast};

  Spot spot(solid, p);
  FieldSample result{1e9, Surface::concrete_cast};
  for (const Cell& cell : solid.cells) {
    const FieldSample s = rough_value(cell, spot);
    if (s.value < result.value) result = s;
  }
  for (const Cell& hollow : solid.hollows) result = cut_hollow(result, hollow, spot);
  return result;
}

Aabb bounds(const Solid& solid) {
  Aabb box;
  for (const Cell& cell : solid.cells) {
    for (const Vec3& corner : corners_of(cell)) box.include(corner);
  }
  return box;
}

}  // namespace rubble::generator
