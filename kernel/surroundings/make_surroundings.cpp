#include "kernel/surroundings/make_surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/surroundings/street_section.h"

namespace rubble {
namespace {

using S = StreetSection;
constexpr double kHalfTurn = portable::kPi;

// Puts things down, in the frame of the street.
class Site {
 public:
  Site(const SurroundingsSpec& spec, std::uint64_t seed, double circle, bool lit, double wetness)
      : spec_(spec), seed_(seed), lit_(lit), wetness_(wetness), ground_(street_of(circle), seed), street_(street_of(circle)) {}

  Surroundings make() {
    add_street();
    add_rows();
    add_rear();
    add_lamps();
    add_vehicles();
    add_trees();
    add_fences();
    add_skyline();
    add_puddles();
    out_.lit = lit_;
    return std::move(out_);
  }

 private:
  static StreetSection street_of(double circle) {
    StreetSection street;
    street.circle = circle;
    return street;
  }
  RandomStream stream(const char* name) const { return {seed_, std::string("surroundings.") + name}; }

  std::uint32_t keep(SurroundingMesh mesh) {
    out_.meshes.push_back(std::make_shared<const SurroundingMesh>(std::move(mesh)));
    return std::uint32_t(out_.meshes.size() - 1);
  }
  void put(SurroundingKind kind, std::uint32_t mesh, const Vec3& at = {}, double yaw = 0, double scale = 1) {
    out_.things.push_back({kind, mesh, {portable::quat_from_rpy(0, 0, yaw), at}, scale});
  }
  bool lies_free(double x, double y, double room) const {
    return std::sqrt(x * x + y * y) > street_.circle + room;
  }

  void add_street() {
    RandomStream random = stream("street");
    put(SurroundingKind::road, keep(make_road(street_, spec_.reach, random)));
    put(SurroundingKind::road, keep(make_road_patches(street_, spec_.reach, random)));
    put(SurroundingKind::kerb, keep(make_kerbs(street_, spec_.reach, random)));
    put(SurroundingKind::pavement, keep(make_pavements(street_, spec_.reach, random)));
    put(SurroundingKind::soil, keep(make_soil(street_, ground_, spec_.reach)));
    put_some(SurroundingKind::soil, make_tufts(street_, ground_, spec_.reach, random));
  }
  // Last, so that the numbers of all others, which their looks vary by, are those of a dry street.
  void add_puddles() {
    RandomStream random = stream("puddles");
    put_some(SurroundingKind::puddle, make_puddles(street_, spec_.reach, wetness_, random));
  }
  void put_some(SurroundingKind kind, SurroundingMesh mesh) {
    if (!mesh.levels.empty()) put(kind, keep(std::move(mesh)));
  }

  NeighbourPlan draw_plan(RandomStream& random) const {
    NeighbourPlan plan;
    const int low = int(spec_.storeys[0]), high = int(spec_.storeys[1]);
    plan.width = random.uniform(10, 18), plan.depth = random.uniform(10, 12.5);
    plan.storeys = low + int(random.below(std::uint64_t(std::max(1, high - low + 1))));
    plan.lit = lit_ ? spec_.lit_windows : 0;
    return plan;
  }

  // Fronts side by side from x outwards; sign: which way. towards: -1 on the pile's side of the street, whose
  // fronts look to -y.
  void add_row(double from, double sign, double towards, RandomStream& random) {
    const double edge = towards < 0 ? street_.near_edge() : street_.far_edge();
    for (double x = from; x < spec_.reach;) {
      NeighbourPlan plan = draw_plan(random);
      const double gap = random.uniform() < 0.18 ? random.uniform(3, 7) : 0;
      plan.windows_left = plan.windows_right = gap > 0;
      // Its own left, seen from its front, is towards +x for what looks to +y.
      const double left = sign > 0 ? x : -x - plan.width;
      const std::uint32_t mesh = keep(make_building(plan, random));
      if (towards < 0)
        put(SurroundingKind::building, mesh, {left, edge, S::kBack}, 0);
      else
        put(SurroundingKind::building, mesh, {left + plan.width, edge, S::kBack}, kHalfTurn);
      x += plan.width + gap + 0.01;
    }
  }
  void add_rows() {
    RandomStream random = stream("fronts");
    add_row(street_.circle + 1.2, 1, -1, random), add_row(street_.circle + 1.2, -1, -1, random);
    const double split = random.uniform(-6, 6);
    add_row(split, 1, 1, random), add_row(-split, -1, 1, random);
  }

  // Backs of the next street's buildings.
  double rear_edge() const { return street_.circle + 15; }
  void add_rear() {
    RandomStream random = stream("rear");
    for (double x = -spec_.reach * 0.7; x < spec_.reach * 0.7;) {
      NeighbourPlan plan = draw_plan(random);
      const double gap = random.uniform() < 0.4 ? random.uniform(2.5, 9) : 0, y = rear_edge() + random.uniform(0, 4);
      plan.windows_left = plan.windows_right = gap > 0;
      const double z = ground_.height(x + plan.width / 2, y) - 0.1;
      put(SurroundingKind::building, keep(make_building(plan, random)), {x + plan.width, y + plan.depth, z}, kHalfTurn);
      x += plan.width + gap + 0.01;
    }
  }

  void add_lamps() {
    const std::uint32_t mesh = keep(make_street_lamp(lit_));
    constexpr double kEvery = 25, kAway = S::kHalf + 0.5;
    const double z = S::kGutter + S::kUpstand;
    for (int i = -int(spec_.reach / kEvery); i <= int(spec_.reach / kEvery); ++i) {
      const double x = kEvery * i + 4;
      for (const double side : {-1.0, 1.0}) {
        const double along = x + (side > 0 ? kEvery / 2 : 0);
        const Vec3 at(along, street_.middle() + side * kAway, z);
        put(SurroundingKind::street_lamp, mesh, at, side > 0 ? kHalfTurn : 0);
        out_.lamps.push_back(out_.things.back().world_from_mesh * lamp_place());
      }
    }
    std::stable_sort(out_.lamps.begin(), out_.lamps.end(), [](const Vec3& a, const Vec3& b) { return norm(a) < norm(b); });
  }

  void add_vehicles() {
    RandomStream random = stream("vehicles");
    std::vector<std::uint32_t> meshes;
    for (int i = 0; i < kVehicles; ++i) meshes.push_back(keep(make_vehicle(i)));
    for (const double side : {-1.0, 1.0})
      for (double x = -spec_.reach; x < spec_.reach; x += 6.2) {
        const int number = random.uniform() < 0.12 ? 6 + int(random.below(3)) : int(random.below(6));
        const double along = x + random.uniform(0, 0.9), off = S::kHalf - 1.02 + random.uniform(-0.08, 0.08);
        const double yaw = (side > 0 ? kHalfTurn : 0) + random.uniform(-0.02, 0.02);
        const bool taken = random.uniform() < spec_.vehicles;
        // Before the pile the street is closed to parking; trees stand in every third place.
        if (!taken || (side > 0 && std::fabs(along) < street_.circle + 3) || is_tree_place(x)) continue;
        const double y = street_.middle() + side * off;
        put(SurroundingKind::vehicle, meshes[std::size_t(number)], {along, y, S::kGutter + S::kFall * 1.02}, yaw);
      }
  }
  bool is_tree_place(double x) const { return int(std::floor((x + spec_.reach) / 6.2 + 0.5)) % 3 == 1; }

  void add_trees() {
    RandomStream random = stream("trees");
    std::vector<std::uint32_t> meshes;
    for (int i = 0; i < 4; ++i) meshes.push_back(keep(make_tree(random.uniform(6.5, 9.5), random)));
    const auto plant = [&](double x, double y, double z) {
      const double scale = random.uniform(0.75, 1.15), yaw = random.uniform(0, 2 * kHalfTurn);
      const std::uint32_t mesh = meshes[random.below(meshes.size())];
      const bool there = random.uniform() < spec_.trees;
      if (there && lies_free(x, y, 3.5)) put(SurroundingKind::tree, mesh, {x, y, z}, yaw, scale);
    };
    for (const double side : {-1.0, 1.0})
      for (double x = -spec_.reach; x < spec_.reach; x += 6.2)
        if (is_tree_place(x) && !(side > 0 && std::fabs(x) < street_.circle + 4))
          plant(x + 0.5, street_.middle() + side * (S::kHalf - 0.9), S::kGutter);
    for (int i = 0; i < 34; ++i) {
      const double x = random.uniform(-0.6, 0.6) * spec_.reach, y = random.uniform(street_.circle + 4, rear_edge() - 3);
      const bool yard = std::fabs(x) < street_.circle || y > 13 + street_.near_edge() + 4;
      if (yard) plant(x, y, ground_.height(x, y) - 0.05);
    }
  }

  void add_fences() {
    RandomStream random = stream("fences");
    const double y = street_.circle + 7.5;
    for (double x = -street_.circle - 26; x < street_.circle + 26;) {
      const double length = random.uniform(5, 11), u = random.uniform();
      SurroundingMesh mesh = u < 0.25   ? make_hedge(length, random.uniform(1.3, 1.9), random)
                             : u < 0.45 ? make_fence(FenceKind::wall, length, random)
                             : u < 0.8  ? make_fence(FenceKind::boards, length, random)
                                        : make_fence(FenceKind::mesh, length, random);
      put(SurroundingKind::fence, keep(std::move(mesh)), {x, y, ground_.height(x + length / 2, y)});
      x += length + (random.uniform() < 0.2 ? 2.5 : 0.05);
    }
    // Around the site towards the street, with a way in.
    const double half = street_.circle, front = street_.near_edge() + 0.12;
    const double part = 0.45 * half;
    const std::uint32_t site = keep(make_fence(FenceKind::mesh, part, random));
    for (const double x : {-half, half - part}) put(SurroundingKind::fence, site, {x, front, S::kBack});
  }

  void add_skyline() {
    RandomStream random = stream("skyline");
    std::vector<std::uint32_t> meshes;
    for (int i = 0; i < 12; ++i) {
      NeighbourPlan plan = draw_plan(random);
      plan.plain = true, plan.windows_left = plan.windows_right = true;
      plan.width *= random.uniform(1, 2.2);
      plan.storeys += i < 8 ? int(random.below(3)) : 4 + int(random.below(9));
      meshes.push_back(keep(make_building(plan, random)));
    }
    const double behind = rear_edge() + 30;
    for (int i = 0; i < 170; ++i) {
      const portable::SinCos t = portable::sincos(random.uniform(0, 2 * portable::kPi));
      const double r = (spec_.reach + 340) * std::sqrt(random.uniform(0.02, 1)), x = r * t.cos, y = r * t.sin;
      const std::uint32_t mesh = meshes[random.below(random.uniform() < 0.85 ? 8 : 12)];
      const double quarter = kHalfTurn / 2 * double(random.below(4)), yaw = quarter + random.uniform(-0.15, 0.15);
      const bool corridor = std::fabs(y - street_.middle()) < 62 && r < spec_.reach + 320;
      if (corridor || (y > 0 && y < behind + 34) || !lies_free(x, y, 60)) continue;
      put(SurroundingKind::skyline, mesh, {x, y, 0}, yaw);
    }
    put(SurroundingKind::skyline, keep(make_hills(ground_, spec_.reach + 150)));
  }

  SurroundingsSpec spec_;
  std::uint64_t seed_;
  bool lit_;
  double wetness_;
  RoughGround ground_;
  StreetSection street_;
  Surroundings out_;
};

}  // namespace

Circle find_pile_circle(const PileState& pile, const std::vector<const TriangleMesh*>& meshes) {
  Aabb box;
  std::vector<Vec3> corners;
  for (const PieceState& piece : pile.pieces) {
    if (piece.status == PieceStatus::lost) continue;
    const Aabb own = meshes[std::size_t(piece.type)]->bounds();
    if (own.empty()) continue;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? own.max.x : own.min.x, i & 2 ? own.max.y : own.min.y, i & 4 ? own.max.z : own.min.z);
      corners.push_back(piece.world_from_body * (corner * piece.scale));
      box.include(corners.back());
    }
  }
  if (box.empty()) return {};
  Circle out{(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, 0};
  for (const Vec3& p : corners) {
    const double dx = p.x - out.x, dy = p.y - out.y;
    out.radius = std::max(out.radius, std::sqrt(dx * dx + dy * dy));
  }
  return out;
}

Surroundings make_surroundings(const SurroundingsSpec& spec, std::uint64_t seed, const Circle& pile, bool dark,
                               double wetness) {
  if (!spec.on()) return {};
  const bool lit = spec.lamps == StreetLampState::on || (spec.lamps == StreetLampState::automatic && dark);
  Surroundings out = Site(spec, seed, pile.radius + spec.clearance, lit, wetness).make();
  const Pose world{portable::quat_from_rpy(0, 0, spec.turn_deg * portable::kPi / 180), {pile.x, pile.y, 0}};
  for (SurroundingThing& thing : out.things) thing.world_from_mesh = world * thing.world_from_mesh;
  for (Vec3& lamp : out.lamps) lamp = world * lamp;
  return out;
}

namespace {

bool is_solid(SurroundingKind kind) { return kind != SurroundingKind::puddle && kind != SurroundingKind::skyline; }

// Of sheets that give way.
bool is_foliage(const std::string& look) { return look == "leaves" || look == "grass"; }

// By triangle of a mesh: whether it is solid. The ground looks like grass, too, but is no tuft of it.
std::vector<std::uint8_t> find_solid(const SurroundingMesh& mesh) {
  const TriangleMesh& finest = mesh.levels.front();
  std::vector<std::uint8_t> solid(finest.triangles.size(), 1);
  if (!mesh.leafy) return solid;
  for (std::size_t t = 0; t < solid.size() && t < finest.surfaces.size(); ++t)
    solid[t] = !is_foliage(finest.surface_names[finest.surfaces[t]]);
  return solid;
}

}  // namespace

TriangleMesh make_solid_surface(const Surroundings& surroundings, double reach) {
  std::vector<std::vector<std::uint8_t>> solid;
  for (const auto& mesh : surroundings.meshes) solid.push_back(find_solid(*mesh));
  TriangleMesh out;
  for (const SurroundingThing& thing : surroundings.things) {
    if (!is_solid(thing.kind)) continue;
    const TriangleMesh& mesh = surroundings.meshes[thing.mesh]->levels.front();
    std::vector<Vec3f> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) positions.push_back(Vec3f(thing.world_from_mesh * (Vec3(p) * thing.scale)));
    const auto is_near = [&](std::uint32_t corner) {
      const Vec3f& p = positions[corner];
      return double(p.x) * double(p.x) + double(p.y) * double(p.y) < reach * reach;
    };
    std::vector<std::int64_t> number(positions.size(), -1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& corners = mesh.triangles[t];
      if (!solid[thing.mesh][t] || !std::any_of(corners.begin(), corners.end(), is_near)) continue;
      std::array<std::uint32_t, 3> made;
      for (int k = 0; k < 3; ++k) {
        std::int64_t& known = number[corners[std::size_t(k)]];
        if (known < 0) {
          known = std::int64_t(out.positions.size());
          out.positions.push_back(positions[corners[std::size_t(k)]]);
        }
        made[std::size_t(k)] = std::uint32_t(known);
      }
      out.triangles.push_back({made[0], made[1], made[2]});
    }
  }
  return out;
}

}  // namespace rubble
