#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/surroundings/facade.h"
#include "kernel/surroundings/parts.h"

namespace rubble {

namespace {

constexpr double kSunk = 0.6;  // of walls into the ground; unit: m

enum class Roof { gable, hip, flat };

// What is drawn before anything is built.
struct Design {
  NeighbourPlan plan;
  double ground_height = 3.8, storey_height = 3.0;  // unit: m
  Roof roof = Roof::gable;
  double pitch = 0.8;  // rise per metre
  WallLooks looks;
  bool cornice = false, plinth = true;
  std::array<Facade, 4> sides;  // front, right, back, left
  std::vector<double> heights;  // at which every wall is cut
  std::vector<Vec3> chimneys;   // their middles
  double eaves() const { return ground_height + storey_height * (plan.storeys - 1); }
};

std::string pick(RandomStream& random, const std::vector<std::string>& from) {
  return from[random.below(from.size())];
}

void draw_looks(Design& d, RandomStream& random) {
  static const std::vector<std::string> kWalls{"render", "render", "render", "brickwork", "brickwork", "render",
                                               "concrete_cast"};
  d.looks.upper = pick(random, kWalls);
  d.looks.ground = random.uniform() < 0.35 ? pick(random, {"concrete_cast", "render", "brickwork"}) : d.looks.upper;
  d.looks.frame = random.uniform() < 0.6 ? "drywall" : random.uniform() < 0.5 ? "timber" : "rubber";
  d.looks.door = pick(random, {"timber", "car_paint", "paint_red", "rubber"});
  d.looks.ground_top = d.ground_height - 0.15;
}

// How a storey's windows are, the same in each of them.
struct WindowDesign {
  double width, height, sill, bay;
  int leaves, balcony_every, balcony_kind;
};

WindowDesign draw_windows(RandomStream& random) {
  WindowDesign w{};
  w.width = random.uniform(0.95, 1.7), w.height = random.uniform(1.25, 1.65), w.sill = random.uniform(0.75, 0.95);
  w.bay = w.width + random.uniform(1.0, 1.7);
  w.leaves = w.width > 1.45 ? 3 : 2;
  w.balcony_every = random.uniform() < 0.5 ? int(random.below(3)) + 2 : 0;
  w.balcony_kind = int(random.below(2)) + 1;
  return w;
}

void dress(Opening& o, double lit, RandomStream& random) {
  const double light = random.uniform(), u = random.uniform(), drop = random.uniform(0.1, 0.7);
  o.lit = light < lit;  // by night the same building as by day
  o.blind = o.lit ? 0 : u < 0.12 ? 1.0 : u < 0.4 ? drop : 0;
  o.curtain = random.uniform() < 0.45;
}

void add_upper_windows(const Design& d, const WindowDesign& w, double lit, bool balconies, int from, Facade& facade,
                       RandomStream& random) {
  const int bays = std::max(1, int(facade.width / w.bay));
  const double step = facade.width / bays;
  for (int storey = from; storey < d.plan.storeys; ++storey)
    for (int i = 0; i < bays; ++i) {
      const double floor = storey == 0 ? 0.5 : d.ground_height + d.storey_height * (storey - 1);
      const double x = step * (i + 0.5);
      Opening o;
      o.left = x - w.width / 2, o.right = x + w.width / 2, o.leaves = w.leaves;
      o.low = floor + w.sill, o.high = floor + std::min(w.sill + w.height, d.storey_height - 0.35);
      dress(o, lit, random);
      if (balconies && storey > 0 && w.balcony_every && i % w.balcony_every == w.balcony_every / 2 && step > 2.2) {
        o.balcony = w.balcony_kind, o.low = floor + 0.06;
        o.blind *= 0.4;
      }
      facade.openings.push_back(o);
    }
}

// The ground floor towards the street: a door, and shops or windows.
void add_ground_floor(const Design& d, const WindowDesign& w, double lit, Facade& facade, RandomStream& random) {
  const bool shops = random.uniform() < 0.45;
  const int bays = std::max(2, int(facade.width / (shops ? 3.6 : w.bay)));
  const double step = facade.width / bays;
  const int door = int(random.below(std::uint64_t(bays)));
  for (int i = 0; i < bays; ++i) {
    const double x = step * (i + 0.5);
    Opening o;
    dress(o, shops ? std::min(1.0, 1.5 * lit) : lit, random);
    if (i == door) {
      o.kind = Opening::Kind::door, o.leaves = step > 2.4 ? 2 : 1, o.balcony = 0;
      const double half = o.leaves == 2 ? 0.75 : 0.5;
      o.left = x - half, o.right = x + half, o.low = 0.12, o.high = 2.75;
    } else if (shops) {
      o.kind = Opening::Kind::shop, o.leaves = 2;
      o.left = x - step / 2 + 0.3, o.right = x + step / 2 - 0.3, o.low = 0.25, o.high = d.ground_height - 1.0;
    } else {
      o.left = x - w.width / 2, o.right = x + w.width / 2, o.leaves = w.leaves, o.low = 1.25, o.high = 1.25 + w.height;
    }
    facade.openings.push_back(o);
  }
}

void find_heights(Design& d) {
  d.heights = {-kSunk, d.looks.ground_top, d.eaves()};
  for (const Facade& side : d.sides)
    for (const Opening& o : side.openings) d.heights.push_back(o.low), d.heights.push_back(o.high);
  std::sort(d.heights.begin(), d.heights.end());
  d.heights.erase(std::unique(d.heights.begin(), d.heights.end()), d.heights.end());
}

Design draw_design(const NeighbourPlan& plan, RandomStream& random) {
  Design d;
  d.plan = plan;
  d.ground_height = random.uniform(3.4, 4.1), d.storey_height = random.uniform(2.75, 3.2);
  const double u = random.uniform();
  d.roof = u < (plan.storeys > 4 ? 0.65 : 0.35) ? Roof::flat : u < 0.85 ? Roof::gable : Roof::hip;
  d.pitch = random.uniform(0.55, 0.95);
  d.cornice = random.uniform() < 0.6, d.plinth = random.uniform() < 0.7;
  draw_looks(d, random);
  const WindowDesign w = draw_windows(random);
  d.sides[0].width = d.sides[2].width = plan.width, d.sides[1].width = d.sides[3].width = plan.depth;
  add_ground_floor(d, w, plan.lit, d.sides[0], random);
  add_upper_windows(d, w, plan.lit, true, 1, d.sides[0], random);
  if (plan.windows_right) add_upper_windows(d, w, plan.lit, false, 0, d.sides[1], random);
  add_upper_windows(d, w, plan.lit, random.uniform() < 0.6, 0, d.sides[2], random);
  if (plan.windows_left) add_upper_windows(d, w, plan.lit, false, 0, d.sides[3], random);
  const int chimneys = d.roof == Roof::flat ? 0 : 1 + int(random.below(3));
  for (int i = 0; i < chimneys; ++i)
    d.chimneys.push_back({plan.width * random.uniform(0.12, 0.88), plan.depth * random.uniform(0.42, 0.58), 0});
  find_heights(d);
  return d;
}

Pose side_frame(const NeighbourPlan& plan, int side) {
  const double turn = portable::kPi / 2 * side;
  const Vec3 at[4] = {{0, 0, 0}, {plan.width, 0, 0}, {plan.width, plan.depth, 0}, {0, plan.depth, 0}};
  return {portable::quat_from_rpy(0, 0, turn), at[side]};
}

// A slab of a roof: its lower edge from a to b, its upper one from d to c; thickness downwards.
void roof_slab(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, MeshBuilder& out) {
  const Vec3 down(0, 0, -0.18);
  out.look("roof_tiles");
  out.quad(a, b, c, d);
  out.look("timber");
  out.quad(d + down, c + down, b + down, a + down);
  out.quad(a + down, b + down, b, a), out.quad(b + down, c + down, c, b);
  out.quad(c + down, d + down, d, c), out.quad(d + down, a + down, a, d);
}

void add_gable(const Design& d, MeshBuilder& out) {
  const double w = d.plan.width, t = d.plan.depth, z = d.eaves(), over = 0.45;
  const double ridge = z + d.pitch * t / 2, low = z - d.pitch * over;
  const double up = 0.18;  // the slab lies on the walls
  out.look(d.looks.upper);
  out.triangle({w, 0, z}, {w, t, z}, {w, t / 2, ridge}), out.triangle({0, t, z}, {0, 0, z}, {0, t / 2, ridge});
  roof_slab({-0.12, -over, low + up}, {w + 0.12, -over, low + up}, {w + 0.12, t / 2, ridge + up},
            {-0.12, t / 2, ridge + up}, out);
  roof_slab({w + 0.12, t + over, low + up}, {-0.12, t + over, low + up}, {-0.12, t / 2, ridge + up},
            {w + 0.12, t / 2, ridge + up}, out);
}

void add_hip(const Design& d, MeshBuilder& out) {
  const double o = 0.45, x0 = -o, x1 = d.plan.width + o, y0 = -o, y1 = d.plan.depth + o, z = d.eaves();
  const double half = std::min(x1 - x0, y1 - y0) / 2, top = z + d.pitch * half;
  const Vec3 a(x0, y0, z), b(x1, y0, z), c(x1, y1, z), e(x0, y1, z);
  const bool wide = x1 - x0 > y1 - y0;
  const Vec3 p = wide ? Vec3(x0 + half, (y0 + y1) / 2, top) : Vec3((x0 + x1) / 2, y0 + half, top);
  const Vec3 q = wide ? Vec3(x1 - half, (y0 + y1) / 2, top) : Vec3((x0 + x1) / 2, y1 - half, top);
  out.look("roof_tiles");
  if (wide)
    out.quad(a, b, q, p), out.quad(c, e, p, q), out.triangle(b, c, q), out.triangle(e, a, p);
  else
    out.quad(b, c, q, p), out.quad(e, a, p, q), out.triangle(a, b, p), out.triangle(c, e, q);
  out.look("timber");
  out.quad(e, c, b, a);
}

void add_flat(const Design& d, bool plain, MeshBuilder& out) {
  const double w = d.plan.width, t = d.plan.depth, z = d.eaves(), p = 0.3, h = 0.55;
  out.look("asphalt");
  out.quad({p, p, z}, {w - p, p, z}, {w - p, t - p, z}, {p, t - p, z});
  out.look("concrete_cast");
  out.box({-0.06, -0.06, z - 0.02}, {w + 0.06, p, z + h}), out.box({-0.06, t - p, z - 0.02}, {w + 0.06, t + 0.06, z + h});
  out.box({-0.06, p, z - 0.02}, {p, t - p, z + h}), out.box({w - p, p, z - 0.02}, {w + 0.06, t - p, z + h});
  out.look("render");
  out.box({w * 0.4, t * 0.4, z - 0.02}, {w * 0.4 + 3.2, t * 0.4 + 3.6, z + 2.5});
  if (plain) return;
  out.look("steel_galvanised");
  for (const double x : {0.15, 0.28, 0.8}) out.tube({w * x, t * 0.7, z}, {w * x, t * 0.7, z + 0.9}, 0.08, 0.08, 8);
  out.box({w * 0.72, t * 0.3, z + 0.1}, {w * 0.72 + 1.3, t * 0.3 + 0.8, z + 1.0});
}

// A mast with an aerial, gutters and downpipes, a moulding below the eaves, a plinth.
void add_trim(const Design& d, MeshBuilder& out) {
  const double w = d.plan.width, t = d.plan.depth, z = d.eaves();
  out.look("steel_galvanised");
  for (const double x : {0.12, w - 0.12}) out.tube({x, -0.07, 0}, {x, -0.07, z - 0.1}, 0.05, 0.05, 8);
  if (d.roof != Roof::flat) {
    const double low = z - 0.45 * d.pitch + (d.roof == Roof::hip ? 0.45 * d.pitch - 0.1 : 0);
    out.tube({0, -0.5, low + 0.02}, {w, -0.5, low + 0.02}, 0.07, 0.07, 8);
  }
  out.look(d.looks.upper == "brickwork" ? "concrete_cast" : d.looks.upper);
  if (d.cornice) {
    out.box({0, -0.2, z - 0.32}, {w, 0, z - 0.14}), out.box({0, -0.1, z - 0.44}, {w, 0, z - 0.32});
    out.box({0, -0.07, d.looks.ground_top - 0.05}, {w, 0, d.looks.ground_top + 0.12});
  }
  out.look("concrete_cast");
  if (!d.plinth) return;
  double x = 0;  // between the doors
  std::vector<std::pair<double, double>> gaps;
  for (const Opening& o : d.sides[0].openings)
    if (o.kind != Opening::Kind::window) gaps.push_back({o.left - 0.02, o.right + 0.02});
  std::sort(gaps.begin(), gaps.end());
  gaps.push_back({w, w});
  for (const auto& [from, to] : gaps) {
    if (from > x + 0.05) out.box({x, -0.035, -0.3}, {from, 0, 0.48});
    x = to;
  }
  out.box({w, 0, -0.3}, {w + 0.035, t, 0.48}), out.box({-0.035, 0, -0.3}, {0, t, 0.48});
}

void add_chimneys(const Design& d, MeshBuilder& out) {
  for (const Vec3& at : d.chimneys) {
    const double top = d.eaves() + d.pitch * d.plan.depth / 2 + 0.9;
    out.look("brickwork");
    out.box({at.x - 0.45, at.y - 0.3, d.eaves()}, {at.x + 0.45, at.y + 0.3, top});
    out.look("concrete_cast");
    out.box({at.x - 0.5, at.y - 0.35, top}, {at.x + 0.5, at.y + 0.35, top + 0.08});
    out.look("brick_fracture");
    for (const double x : {-0.22, 0.22}) out.tube({at.x + x, at.y, top}, {at.x + x, at.y, top + 0.4}, 0.1, 0.09, 8);
  }
}

TriangleMesh build(const Design& d, bool plain) {
  MeshBuilder out;
  for (int side = 0; side < 4; ++side) {
    Facade facade = d.sides[std::size_t(side)];
    out.frame(side_frame(d.plan, side));
    if (plain) {
      add_panes(facade, out);
      facade.openings.clear();
      add_wall(facade, {-kSunk, d.looks.ground_top, d.eaves()}, d.looks, out);
    } else {
      add_wall(facade, d.heights, d.looks, out);
      add_openings(facade, d.looks, out);
    }
  }
  out.frame({});
  if (d.roof == Roof::gable) add_gable(d, out);
  if (d.roof == Roof::hip) add_hip(d, out);
  if (d.roof == Roof::flat) add_flat(d, plain, out);
  add_chimneys(d, out);
  if (!plain) add_trim(d, out);
  return out.take();
}

}  // namespace

SurroundingMesh make_building(const NeighbourPlan& plan, RandomStream& random) {
  const Design design = draw_design(plan, random);
  SurroundingMesh out;
  if (!plan.plain) out.levels.push_back(build(design, false));
  out.levels.push_back(build(design, true));
  out.light_spacing = plan.plain ? 4 : 1.2;
  return out;
}

}  // namespace rubble
