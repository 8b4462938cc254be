// Posed figures of people, for missions that search for them: adults of 1.75 m in clothes, grey with dust.
// Rigid: what lies in debris for hours hardly moves. Sizes of limbs as in NASA-STD-3000, rounded.
#include <array>
#include <cmath>

#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

constexpr Surface kClothes = Surface::fabric;
constexpr Surface kSkin = Surface::plaster;  // under dust
constexpr Surface kBoots = Surface::rubber;

struct Limbs {  // of one side
  Vec3 shoulder, elbow, wrist, hip, knee, ankle, toe;
};

// Joints; the origin is the middle of the trunk. unit: m
struct Posture {
  Vec3 head, chest, pelvis;  // of the trunk its ends
  Vec3 across;               // from the right side to the left; unit length
  std::array<Limbs, 2> sides;
};

Vec3 across_of(const Vec3& d) {
  const Vec3 axis = std::fabs(d.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(cross(d, axis));
}

// A rod from a to b with a square of planes around it; its ends reach `over` beyond.
Cell rod(const Vec3& a, const Vec3& b, double radius, double over, Surface surface) {
  const Vec3 d = normalized(b - a), u = across_of(d), v = cross(d, u);
  const double clear = 1.25 * radius + 0.05;
  Cell cell{{d, dot(d, b) + over, surface}, {-d, -dot(d, a) + over, surface}};
  for (const Vec3& side : {u, -u, v, -v}) cell.push_back({side, dot(side, a) + clear, surface});
  cell.push_back({d, radius, surface, true, false, a});
  return cell;
}

// A box along a to b, `width` across and `depth` thick.
Cell slab(const Vec3& a, const Vec3& b, const Vec3& across, double width, double depth, double over) {
  const Vec3 d = normalized(b - a), v = normalized(across - d * dot(across, d)), n = cross(d, v);
  Cell cell{{d, dot(d, b) + over, kClothes}, {-d, -dot(d, a) + over, kClothes}};
  for (const double sign : {1.0, -1.0}) {
    cell.push_back({v * sign, sign * dot(v, a) + 0.5 * width, kClothes});
    cell.push_back({n * sign, sign * dot(n, a) + 0.5 * depth, kClothes});
  }
  // Shoulders and flanks are not square.
  for (const double s : {1.0, -1.0})
    for (const double t : {1.0, -1.0}) {
      const Vec3 edge = normalized(v * s + n * t);
      cell.push_back({edge, dot(edge, a) + 0.335 * (width + depth), kClothes});
    }
  return cell;
}

// What collides of a rod: a prism of six sides with the rod's section, to within a twentieth.
std::vector<Vec3> prism(const Vec3& a, const Vec3& b, double radius, double over) {
  const Vec3 d = normalized(b - a), u = across_of(d), v = cross(d, u);
  const double half = 0.8660254037844386;  // sin 60 degrees
  const double turn[6][2] = {{1, 0}, {0.5, half}, {-0.5, half}, {-1, 0}, {-0.5, -half}, {0.5, -half}};
  std::vector<Vec3> points;
  for (const Vec3& end : {a - d * over, b + d * over})
    for (const auto& t : turn) points.push_back(end + (u * t[0] + v * t[1]) * (1.07 * radius));
  return points;
}

// A head is what two rods of 18 cm have in common, one upright and one from ear to ear.
Cell skull(const Vec3& centre, const Vec3& up, const Vec3& across) {
  Cell cell = rod(centre - up * 0.08, centre + up * 0.08, 0.085, 0.035, kSkin);
  cell.push_back({across, 0.115, kSkin, true, false, centre});
  return cell;
}

void add_rod(Recipe& r, const Vec3& a, const Vec3& b, double radius, double over, Surface surface) {
  r.solid.cells.push_back(rod(a, b, radius, over, surface));
  r.parts.push_back(prism(a, b, radius, over));
}

void add_slab(Recipe& r, const Vec3& a, const Vec3& b, const Vec3& across, double width, double depth,
              double over) {
  r.solid.cells.push_back(slab(a, b, across, width, depth, over));
  const Vec3 d = normalized(b - a), v = normalized(across - d * dot(across, d)), n = cross(d, v);
  std::vector<Vec3> points;
  for (const Vec3& end : {a - d * over, b + d * over})
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0}) points.push_back(end + v * (0.47 * s * width) + n * (0.47 * t * depth));
  r.parts.push_back(points);
}

void add_side(const Limbs& l, Recipe& r) {
  add_rod(r, l.shoulder, l.elbow, 0.052, 0.035, kClothes);
  add_rod(r, l.elbow, l.wrist, 0.042, 0.025, kClothes);
  const Vec3 hand = normalized(l.wrist - l.elbow);
  add_rod(r, l.wrist + hand * 0.02, l.wrist + hand * 0.14, 0.036, 0.01, kSkin);
  add_rod(r, l.hip, l.knee, 0.078, 0.045, kClothes);
  add_rod(r, l.knee, l.ankle, 0.055, 0.035, kClothes);
  add_rod(r, l.ankle, l.toe, 0.045, 0.03, kBoots);
}

Recipe figure(const char* name, const Posture& p) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "furniture", fabric_wear(), 0.012);
  r.solid.wear.edge_round = 0.03;
  r.solid.wear.cast_depth = 0.005;
  const Vec3 spine = normalized(p.chest - p.pelvis);
  add_slab(r, p.pelvis + spine * 0.17, p.chest, p.across, 0.36, 0.22, 0.05);
  add_slab(r, p.pelvis, p.pelvis + spine * 0.2, p.across, 0.33, 0.20, 0.07);
  const Vec3 up = normalized(p.head - p.chest);
  add_rod(r, p.chest, p.head, 0.06, 0.0, kSkin);
  r.solid.cells.push_back(skull(p.head, up, normalized(p.across - up * dot(p.across, up))));
  r.parts.push_back(prism(p.head - up * 0.08, p.head + up * 0.08, 0.085, 0.03));
  for (const Limbs& side : p.sides) add_side(side, r);
  r.density = 985;  // of a body, lungs half full
  r.triangles = {4800, 1400, 420};
  r.max_edge = 0.12;
  r.weight = 0;  // never among what falls
  r.tags = {"victim"};
  return r;
}

// Both sides alike but for the sign of y.
std::array<Limbs, 2> mirrored(const Limbs& left) {
  const auto flip = [](const Vec3& p) { return Vec3{p.x, -p.y, p.z}; };
  return {left, Limbs{flip(left.shoulder), flip(left.elbow), flip(left.wrist), flip(left.hip), flip(left.knee),
                      flip(left.ankle), flip(left.toe)}};
}

Recipe supine() {
  return figure("victim_supine",
                {{0.53, 0, 0.02}, {0.22, 0, 0}, {-0.27, 0, 0}, {0, 1, 0},
                 mirrored({{0.2, 0.2, 0}, {-0.07, 0.29, -0.03}, {-0.29, 0.36, -0.05}, {-0.3, 0.1, -0.01},
                           {-0.72, 0.14, -0.02}, {-1.12, 0.17, -0.04}, {-1.15, 0.22, 0.1}})});
}

// On the belly, an arm stretched out ahead.
Recipe prone() {
  return figure("victim_prone",
                {{0.52, 0.03, -0.01}, {0.22, 0, 0}, {-0.27, 0, 0}, {0, 1, 0},
                 {Limbs{{0.2, 0.2, -0.01}, {0.45, 0.33, -0.04}, {0.69, 0.26, -0.06}, {-0.3, 0.1, -0.01},
                        {-0.68, 0.25, -0.03}, {-1.04, 0.14, -0.05}, {-1.19, 0.18, -0.05}},
                  Limbs{{0.2, -0.2, -0.01}, {-0.03, -0.33, -0.04}, {-0.27, -0.3, -0.06}, {-0.3, -0.1, -0.01},
                        {-0.72, -0.13, -0.03}, {-1.11, -0.15, -0.05}, {-1.26, -0.18, -0.05}}}});
}

// On a side, knees drawn up.
Recipe curled() {
  const auto side = [](double z) {
    return Limbs{{0.18, 0.02, 1.15 * z}, {0.05, 0.27, z}, {0.26, 0.4, 0.7 * z}, {-0.27, 0.03, 0.62 * z},
                 {-0.1, 0.39, 0.62 * z}, {-0.47, 0.48, 0.62 * z}, {-0.5, 0.61, 0.62 * z}};
  };
  return figure("victim_curled",
                {{0.5, 0.12, -0.02}, {0.21, 0, 0}, {-0.26, 0, 0}, {0, 0, 1}, {side(0.14), side(-0.14)}});
}

// Leaning back, knees up.
Recipe sitting() {
  return figure("victim_sitting",
                {{-0.06, 0, 0.53}, {-0.09, 0, 0.23}, {0.03, 0, -0.24}, {0, 1, 0},
                 mirrored({{-0.08, 0.2, 0.2}, {-0.02, 0.29, -0.06}, {0.2, 0.24, -0.14}, {0.05, 0.1, -0.24},
                           {0.42, 0.16, -0.02}, {0.62, 0.16, -0.36}, {0.75, 0.18, -0.37}})});
}

}  // namespace

std::vector<Recipe> victim_pieces() { return {supine(), prone(), curled(), sitting()}; }

}  // namespace rubble::generator
