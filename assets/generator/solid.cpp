#include "assets/generator/solid.h"

#include <cmath>

#include "assets/generator/noise.h"
#include "assets/generator/polytope.h"

namespace rubble::generator {
namespace {

constexpr double kDeepest = 0.025;      // what wear removes at most; unit: m
constexpr double kScar = 0.0026;        // an edge that receded farther was chipped; unit: m
constexpr double kHollowRound = 0.009;  // of the inner edges of hollows; unit: m

struct Local {                  // what every face shares at one point
  double roughness;             // of a break, 0 to 1
  double fracture, cast, edge;  // dents of the two kinds of faces, width of edges; unit: m
};

Local calc_local(const Solid& solid, const Vec3& p) {
  const Wear& w = solid.wear;
  const double waves = ridged_noise(p * (1 / w.fracture_size), 3, solid.seed);
  const double flakes = flake_noise(p * (1.7 / w.fracture_size), solid.seed + 51);
  const double grains = grain_noise(p * (1 / w.grain_size), solid.seed + 11);
  const double mixed = 0.45 * std::fmin(1.0, 1.6 * waves) + 0.35 * flakes + 0.2 * (1 - grains);
  const double rough = std::fmin(1.0, std::fmax(0.0, 2.1 * mixed - 0.45));
  const Vec3 in_chips = p * (1 / w.chip_size);
  const double sway = 0.5 + 0.5 * gradient_noise(in_chips, solid.seed + 21);
  const double pits = fractal_noise(in_chips * 2.5, 2, solid.seed + 31) - 0.25;
  const double chips = std::fmax(0.0, 1.4 * fractal_noise(in_chips, 2, solid.seed + 41));
  return {rough, w.fracture_depth * rough,
          w.cast_depth * std::fmin(1.0, 0.3 * std::fmax(0.0, sway) + 2 * std::fmax(0.0, pits)),
          w.edge_round + w.edge_chip * std::fmin(1.0, chips * chips)};
}

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

bool is_fracture(Surface s) {
  return s == Surface::concrete_fracture || s == Surface::brick_fracture;
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

// Where an edge receded far it chipped: the scar is a break, and rough.
FieldSample chip(FieldSample sample, double receded, const Local& local) {
  if (receded < kScar) return sample;
  const double depth = std::fmin(receded - kScar, 0.5 * kScar);
  return {sample.value + depth * local.roughness, broken(sample.surface)};
}

FieldSample rough_value(const Cell& cell, const Vec3& p, const Local& local) {
  FieldSample result{-1e9, Surface::concrete_cast};
  double top = -1e9;
  for (const Face& face : cell) {
    const double relief = is_fracture(face.surface) ? local.fracture : local.cast;
    const double value = plain_value(face, p) + relief;
    if (value > top) {
      top = value;
      result.surface = face.surface;
    }
    result.value = smooth_max(result.value, value, local.edge);
  }
  return chip(result, result.value - top, local);
}

// A hollow is smooth inside: its walls were cast, and its edges are worn where it meets a face.
FieldSample cut_hollow(FieldSample solid, const Cell& hollow, const Vec3& p, const Local& local) {
  double inside = -1e9;
  Surface surface = Surface::concrete_cast;
  for (const Face& face : hollow) {
    const double value = plain_value(face, p);
    if (value > inside) surface = face.surface;
    inside = inside < -1e8 ? value : smooth_max(inside, value, kHollowRound);
  }
  const double cut = -inside + local.cast;
  const double top = std::fmax(cut, solid.value);
  if (cut > solid.value) solid.surface = surface;
  solid.value = smooth_max(solid.value, cut, local.edge);
  return chip(solid, solid.value - top, local);
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

  const Local local = calc_local(solid, p);
  FieldSample result{1e9, Surface::concrete_cast};
  for (const Cell& cell : solid.cells) {
    const FieldSample s = rough_value(cell, p, local);
    if (s.value < result.value) result = s;
  }
  for (const Cell& hollow : solid.hollows) result = cut_hollow(result, hollow, p, local);
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
