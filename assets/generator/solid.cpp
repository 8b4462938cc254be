#include "assets/generator/solid.h"

#include <cmath>

#include "assets/generator/noise.h"
#include "assets/generator/polytope.h"

namespace rubble::generator {
namespace {

constexpr double kScar = 0.0026;        // an edge that receded farther was chipped; unit: m
constexpr double kHollowRound = 0.009;  // of the inner edges of hollows; unit: m

bool is_fracture(Surface s) {
  return s == Surface::concrete_fracture || s == Surface::brick_fracture ||
         s == Surface::timber_fracture || s == Surface::drywall_core;
}

// Beyond this far below the highest face another has no part in the surface. unit: m
double reach_of(const Wear& wear) {
  return wear.edge_round + wear.edge_chip + wear.fracture_depth + wear.cast_depth;
}

// What every face shares at one point, worked out when first asked for: noise is what costs.
class Spot {
 public:
  Spot(const Solid& solid, const Vec3& p)
      : wear_(solid.wear),
        seed_(solid.seed),
        p_(p),
        in_chips_(p * (1 / solid.wear.chip_size)),
        reach_(reach_of(solid.wear)) {}

  const Vec3& position() const { return p_; }
  double reach() const { return reach_; }

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
      const double chips = larger(0.0, 1.4 * fractal_noise(in_chips_, 2, seed_ + 41));
      edge_width_ = wear_.edge_round + wear_.edge_chip * smaller(1.0, chips * chips);
    }
    return edge_width_;
  }

 private:
  // Splinters: bundles of fibres that broke off at different lengths, and single ones between.
  double calc_splinters() const {
    const Vec3 q = p_ + wear_.along * ((1 / wear_.fibre - 1) * dot(p_, wear_.along));
    const double bundles = 0.5 + fractal_noise(q * (1 / wear_.fracture_size), 2, seed_);
    const double fibres = grain_noise(q * (1 / wear_.grain_size), seed_ + 11);
    return smaller(1.0, larger(0.0, 0.8 * bundles + 0.45 * (0.7 - fibres)));
  }
  double calc_roughness() const {
    if (wear_.fibre > 1) return calc_splinters();
    const double waves = ridged_noise(p_ * (1 / wear_.fracture_size), 3, seed_);
    const double flakes = flake_noise(p_ * (1.7 / wear_.fracture_size), seed_ + 51);
    const double grains = grain_noise(p_ * (1 / wear_.grain_size), seed_ + 11);
    const double mixed = 0.45 * smaller(1.0, 1.6 * waves) + 0.35 * flakes + 0.2 * (1 - grains);
    return smaller(1.0, larger(0.0, 2.1 * mixed - 0.45));
  }
  double calc_cast_dent() const {
    const double sway = larger(0.0, 0.5 + 0.5 * gradient_noise(in_chips_, seed_ + 21));
    const double pits = larger(0.0, fractal_noise(in_chips_ * 2.5, 2, seed_ + 31) - 0.25);
    return wear_.cast_depth * smaller(1.0, 0.3 * sway + 2 * pits);
  }

  const Wear& wear_;
  std::uint32_t seed_;
  Vec3 p_, in_chips_;
  double reach_;
  double roughness_ = -1, cast_dent_ = -1, edge_width_ = -1;
};

double plain_value(const Face& face, const Vec3& p) {
  if (!face.round) return dot(face.normal, p) - face.offset;
  const Vec3 d = p - face.centre;
  const double along = dot(face.normal, d);
  return std::sqrt(larger(0.0, dot(d, d) - along * along)) - face.offset;
}

double plain_value(const Cell& cell, const Vec3& p) {
  double value = -1e9;
  for (const Face& face : cell) {
    const double height = plain_value(face, p);
    if (height > value) value = height;
  }
  return value;
}


// The larger of two, blended over the width k: a rounded edge (quadratic, after Quilez).
double smooth_max(double a, double b, double k) {
  const double h = larger(0.0, k - std::fabs(a - b)) / k;
  return larger(a, b) + 0.25 * h * h * k;
}

Surface broken(Surface surface) {
  switch (surface) {
    case Surface::concrete_cast:
      return Surface::concrete_fracture;
    case Surface::brick:
      return Surface::brick_fracture;
    case Surface::timber:
      return Surface::timber_fracture;
    case Surface::drywall:
      return Surface::drywall_core;
    default:
      return surface;
  }
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
    result.value += smaller(receded - kScar, 0.5 * kScar) * spot.roughness();
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
      "concrete_cast", "concrete_fracture", "brick",       "brick_fracture",
      "cinder_block",  "rebar",             "steel_galvanised", "steel_rusty",
      "timber",        "timber_fracture",   "drywall",     "drywall_core",
      "car_paint",     "glass",             "fabric",      "rubber",
      "plaster"};
  return kNames[static_cast<int>(surface)];
}

Cell box_cell(const Vec3& min, const Vec3& max, Surface surface) {
  return {{{1, 0, 0}, max.x, surface}, {{-1, 0, 0}, -min.x, surface},
          {{0, 1, 0}, max.y, surface}, {{0, -1, 0}, -min.y, surface},
          {{0, 0, 1}, max.z, surface}, {{0, 0, -1}, -min.z, surface}};
}

namespace {

bool is_break(const Face& face) { return face.rough || is_fracture(face.surface); }

// What wear removes at most: two edges may meet, and a face is dented besides. unit: m
double deepest(const Wear& wear, bool with_breaks) {
  const double edges = 0.5 * (wear.edge_round + wear.edge_chip) + kScar;
  return edges + wear.cast_depth + (with_breaks ? wear.fracture_depth : 0);
}

}  // namespace

SolidView whole_view(const Solid& solid) {
  SolidView view{&solid, {}, {}, deepest(solid.wear, true)};
  for (const Cell& cell : solid.cells) view.cells.push_back(&cell);
  for (const Cell& hollow : solid.hollows) view.hollows.push_back(&hollow);
  return view;
}

SolidView view_near(const Solid& solid, const Vec3& centre, double radius, double band) {
  SolidView view{&solid, {}, {}, 0};
  const double depth = radius + band + deepest(solid.wear, true);
  bool breaks = false;
  for (const Cell& cell : solid.cells) {
    if (plain_value(cell, centre) >= radius + band) continue;
    view.cells.push_back(&cell);
    for (const Face& face : cell) {
      breaks = breaks || (is_break(face) && plain_value(face, centre) > -depth);
    }
  }
  for (const Cell& hollow : solid.hollows) {
    if (plain_value(hollow, centre) >= depth + reach_of(solid.wear)) continue;
    view.hollows.push_back(&hollow);
    for (const Face& face : hollow) breaks = breaks || is_break(face);
  }
  view.deepest = deepest(solid.wear, breaks);
  return view;
}

double plain_value(const SolidView& solid, const Vec3& p) {
  double plain = 1e9;
  for (const Cell* cell : solid.cells) {
    const double value = plain_value(*cell, p);
    if (value < plain) plain = value;
  }
  for (const Cell* hollow : solid.hollows) {
    const double value = -plain_value(*hollow, p);
    if (value > plain) plain = value;
  }
  return plain;
}

namespace {

// The only face that has a part in the surface near p, or none where several meet.
const Face* find_lone_face(const SolidView& view, const Vec3& p) {
  const double reach = reach_of(view.solid->wear);
  const Face* lone = nullptr;
  double height = 1e9;
  for (const Cell* cell : view.cells) {
    const double highest = plain_value(*cell, p);
    // A higher cell stays above whatever the others' wear does to them.
    if (highest > height + reach) continue;
    const bool only = highest < height - reach;
    if (!only && lone) return nullptr;
    height = highest < height ? highest : height;
    lone = nullptr;
    for (const Face& face : *cell) {
      if (plain_value(face, p) < highest - reach) continue;
      if (lone) return nullptr;
      lone = &face;
    }
  }
  for (const Cell* hollow : view.hollows) {
    if (-plain_value(*hollow, p) >= height - 2 * reach) return nullptr;
  }
  return lone;
}

}  // namespace

FieldSide side_of(const SolidView& view, const Vec3& p) {
  const double plain = plain_value(view, p);
  // Wear only ever removes, but hollows are filled a little along their inner edges.
  if (plain > (view.hollows.empty() ? 0 : kHollowRound)) return FieldSide::outside;
  if (plain < -view.deepest) return FieldSide::inside;
  const Wear& wear = view.solid->wear;
  if (plain >= -wear.cast_depth) return FieldSide::near;
  const Face* lone = find_lone_face(view, p);
  if (!lone) return FieldSide::near;
  return plain < -(is_break(*lone) ? wear.fracture_depth : wear.cast_depth) ? FieldSide::inside
                                                                            : FieldSide::near;
}

Surface surface_at(const SolidView& view, const Vec3& p, double band) {
  const Face* lone = find_lone_face(view, p);
  return lone ? lone->surface : sample(view, p, band).surface;
}

FieldSample sample(const SolidView& view, const Vec3& p, double band) {
  const double plain = plain_value(view, p);
  const Solid& solid = *view.solid;
  // Roughness only ever removes, so outside it is needed on the way to the surface alone.
  if (plain > band || plain < -band - view.deepest) return {plain, Surface::concrete_cast};

  Spot spot(solid, p);
  FieldSample result{1e9, Surface::concrete_cast};
  for (const Cell* cell : view.cells) {
    const FieldSample s = rough_value(*cell, spot);
    if (s.value < result.value) result = s;
  }
  for (const Cell* hollow : view.hollows) result = cut_hollow(result, *hollow, spot);
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
