#include "kernel/surroundings/street_section.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr double kLeastBank = 0.01;  // lower steps need no side; unit: m
constexpr double kBeyond = 160;  // the street goes on so far without details; unit: m

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Lines across the street: even steps as far as there are details, longer ones beyond.
std::vector<double> lines_along(double reach, double step) {
  std::vector<double> xs;
  for (double x = -reach - kBeyond; x < -reach - 1e-6; x += kBeyond / 8) xs.push_back(x);
  const int n = int(2 * reach / step);
  for (int i = 0; i <= n; ++i) xs.push_back(-reach + 2 * reach * i / n);
  for (int i = 1; i <= 8; ++i) xs.push_back(reach + kBeyond * i / 8);
  return xs;
}

double road_height(double off) {
  return StreetSection::kGutter + StreetSection::kFall * (StreetSection::kHalf - std::fabs(off));
}

// A level disc just above the road.
void add_cover(double x, double y, double z, double radius, MeshBuilder& out) {
  out.tube({x, y, z - 0.03}, {x, y, z + 0.004}, radius, radius, 20);
}

}  // namespace

SurroundingMesh make_road(const StreetSection& street, double reach, RandomStream& random) {
  using S = StreetSection;
  const std::vector<double> xs = lines_along(reach, 2.0);
  const std::vector<double> ys{-S::kHalf, -S::kHalf + 0.3, -S::kLanes, -2.1, -1.0, 0, 1.0, 2.1, S::kLanes, S::kHalf - 0.3, S::kHalf};
  const double middle = street.middle();
  std::vector<double> heights;
  for (std::size_t i = 0; i < xs.size(); ++i)
    for (const double y : ys) heights.push_back(road_height(y) + (std::fabs(y) < S::kHalf - 0.1 ? random.uniform(-0.008, 0.008) : 0));
  MeshBuilder out;
  const auto corner = [&](std::size_t i, std::size_t k) {
    return Vec3(xs[i], middle + ys[k], heights[i * ys.size() + k]);
  };
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t k = 0; k + 1 < ys.size(); ++k) {
      const double y = std::fabs(ys[k] + ys[k + 1]) / 2;
      out.look(y > S::kHalf - 0.3 ? "concrete_cast" : y > S::kLanes ? "paving" : "asphalt");
      out.quad(corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1));
    }
  out.look("paper");  // 3 m of line, 6 m of gap
  for (double x = -reach; x + 3 < reach; x += 9) out.box({x, middle - 0.06, 0.1}, {x + 3, middle + 0.06, road_height(0) + 0.011});
  for (double x = -reach + 7; x < reach; x += random.uniform(19, 34)) {
    const double off = random.uniform(-2.4, 2.4);
    out.look("rebar");
    add_cover(x, middle + off, road_height(off) + 0.008, 0.31, out);
    const double side = random.below(2) ? 1.0 : -1.0, grate = side * (S::kHalf - 0.2);
    out.box({x + 5, middle + grate - 0.17, -0.02}, {x + 5.5, middle + grate + 0.17, road_height(grate) + 0.004});
  }
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 0.7;
  return mesh;
}

// Where the road was dug up and mended: of another age, so of another shade.
SurroundingMesh make_road_patches(const StreetSection& street, double reach, RandomStream& random) {
  const double middle = street.middle();
  MeshBuilder out;
  out.look("asphalt");
  for (double x = -reach + 3; x < reach; x += random.uniform(9, 26)) {
    const double y = random.uniform(-2.9, 1.2), w = random.uniform(0.8, 4.5), d = random.uniform(0.6, 1.7);
    const double rise = 0.012;
    const auto at = [&](double px, double py) { return Vec3(px, middle + py, road_height(py) + rise); };
    const double mid = std::clamp(0.0, y, y + d);  // the crown
    if (mid > y) out.quad(at(x, y), at(x + w, y), at(x + w, mid), at(x, mid));
    if (mid < y + d) out.quad(at(x, mid), at(x + w, mid), at(x + w, y + d), at(x, y + d));
  }
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 0.7;
  return mesh;
}

// Stones of 1 m, not quite in line.
SurroundingMesh make_kerbs(const StreetSection& street, double reach, RandomStream& random) {
  using S = StreetSection;
  MeshBuilder out;
  out.look("concrete_cast");
  const double top = S::kGutter + S::kUpstand;
  const auto stone = [&](double x, double length, double side) {
    const double inner = street.middle() + side * (S::kHalf + random.uniform(-0.004, 0.004));
    const double outer = street.middle() + side * (S::kHalf + S::kKerb), lift = random.uniform(-0.004, 0.004);
    const double low = std::min(inner, outer), high = std::max(inner, outer), z = top + lift, b = 0.02;
    const double l = x + 0.003, r = x + length - 0.003, in = side > 0 ? low : high, back = side > 0 ? high : low;
    const double bevel = in + side * b;
    // Front, bevel, top; then the ends.
    const Vec3 p[8] = {{l, in, -0.1}, {r, in, -0.1}, {l, in, z - b}, {r, in, z - b},
                       {l, bevel, z}, {r, bevel, z}, {l, back, z},   {r, back, z}};
    const auto band = [&](int a, int c) {
      if (side > 0)
        out.quad(p[a], p[a + 1], p[c + 1], p[c]);
      else
        out.quad(p[a + 1], p[a], p[c], p[c + 1]);
    };
    band(0, 2), band(2, 4), band(4, 6);
    const Vec3 lb(l, back, -0.1), rb(r, back, -0.1);
    std::vector<Vec3> right{p[1], rb, p[7], p[5], p[3]}, left{p[0], p[2], p[4], p[6], lb};
    if (side < 0) std::reverse(right.begin(), right.end()), std::reverse(left.begin(), left.end());
    out.face(right), out.face(left);
  };
  for (const double side : {-1.0, 1.0}) {
    for (double x = -reach; x < reach; x += 1) stone(x, 1, side);
    for (const double end : {-reach - kBeyond, reach}) stone(end, kBeyond, side);
  }
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 1;
  return mesh;
}

SurroundingMesh make_pavements(const StreetSection& street, double reach, RandomStream& random) {
  using S = StreetSection;
  const std::vector<double> xs = lines_along(reach, 2.5);
  MeshBuilder out;
  out.look("paving");
  for (const double side : {-1.0, 1.0}) {
    const double from = S::kHalf + S::kKerb, to = S::kHalf + S::kPavement, start = S::kGutter + S::kUpstand;
    const auto at = [&](double x, double part, double lift) {
      const double off = from + (to - from) * part;
      return Vec3(x, street.middle() + side * off, start + S::kFall * (off - S::kHalf) + lift);
    };
    std::vector<double> lifts;
    for (std::size_t i = 0; i < xs.size(); ++i) lifts.push_back(random.uniform(-0.006, 0.006));
    const auto put = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
      if (side > 0) out.quad(a, b, c, d);
      else out.quad(b, a, d, c);
    };
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      const double x0 = xs[i], x1 = xs[i + 1], m0 = lifts[i], m1 = lifts[i + 1];
      put(at(x0, 0, 0), at(x1, 0, 0), at(x1, 0.5, m1), at(x0, 0.5, m0));
      put(at(x0, 0.5, m0), at(x1, 0.5, m1), at(x1, 1, 0), at(x0, 1, 0));
      const Vec3 down(0, 0, -0.4);
      put(at(x0, 1, 0), at(x1, 1, 0), at(x1, 1, 0) + down, at(x0, 1, 0) + down);
    }
  }
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 0.7;
  return mesh;
}

double RoughGround::noise(double x, double y, double size, std::uint32_t number) const {
  const double u = x / size, v = y / size, fx = std::floor(u), fy = std::floor(v);
  const auto value = [&](double i, double k) {
    std::uint64_t h = seed_ ^ std::uint64_t(number) * 0x9e3779b97f4a7c15u;
    for (const double c : {i, k}) {
      h = (h ^ std::uint64_t(std::int64_t(c))) * 0xbf58476d1ce4e5b9u;
      h ^= h >> 31;
    }
    return double(h >> 11) * (2.0 / 9007199254740992.0) - 1;
  };
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(u - fx), b = ease(v - fy);
  return (value(fx, fy) * (1 - a) + value(fx + 1, fy) * a) * (1 - b) +
         (value(fx, fy + 1) * (1 - a) + value(fx + 1, fy + 1) * a) * b;
}

double RoughGround::height(double x, double y) const {
  const double away = std::sqrt(x * x + y * y) - street_.circle;
  const double beside = y > street_.middle() ? y - street_.near_edge() : street_.far_edge() - y;
  const double bumps = 0.3 + 0.24 * noise(x, y, 19, 1) + 0.11 * noise(x, y, 6, 2) + 0.035 * noise(x, y, 1.7, 3);
  // Never below the plane: what lies below it has no light.
  const double wild = 0.003 + smoothstep(0.8, 8.8, away) * std::max(bumps, 0.02) +
                      0.018 * (1 + noise(x, y, 0.9, 4)) * smoothstep(0.9, 3, away);
  const double street = smoothstep(0, 5, beside);
  return StreetSection::kBack * (1 - street) + wild * street;
}

namespace {

// Steps that grow away from the middle.
std::vector<double> growing(double from, double to) {
  std::vector<double> out{from};
  const double sign = to > from ? 1 : -1;
  while ((to - out.back()) * sign > 1e-6) {
    const double step = std::clamp(0.09 * (std::fabs(out.back()) - 6), 0.6, 14.0);
    const double next = out.back() + sign * step;
    out.push_back((to - next) * sign < 0.4 * step ? to : next);
  }
  return out;
}

std::vector<double> joined(std::vector<double> low, const std::vector<double>& high) {
  std::reverse(low.begin(), low.end());
  if (!high.empty()) low.insert(low.end(), high.begin() + (low.back() == high.front() ? 1 : 0), high.end());
  return low;
}

// Above 0 where grass grows.
double greenness(const RoughGround& ground, double x, double y, double away) {
  return ground.noise(x, y, 4.5, 7) + 0.6 * ground.noise(x, y, 1.3, 8) + 0.22 * (away - 5);
}

// With a bank down to the plane where it ends at the circle.
void add_field(const StreetSection& street, const RoughGround& ground, const std::vector<double>& xs,
               const std::vector<double>& ys, MeshBuilder& out) {
  const auto is_free = [&](double x, double y) { return x * x + y * y > street.circle * street.circle; };
  const auto is_there = [&](std::size_t i, std::size_t k) {
    return is_free(xs[i], ys[k]) && is_free(xs[i + 1], ys[k]) && is_free(xs[i], ys[k + 1]) && is_free(xs[i + 1], ys[k + 1]);
  };
  const auto at = [&](double x, double y) { return Vec3(x, y, ground.height(x, y)); };
  const auto add_bank = [&](const Vec3& a, const Vec3& b) {  // seen from the circle, a is on the left
    if (std::max(a.z, b.z) > kLeastBank) out.quad(a, Vec3(a.x, a.y, 0), Vec3(b.x, b.y, 0), b);
  };
  const std::size_t columns = xs.size() - 1, rows = ys.size() - 1;
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t k = 0; k < rows; ++k) {
      if (!is_there(i, k)) continue;
      const double mx = (xs[i] + xs[i + 1]) / 2, my = (ys[k] + ys[k + 1]) / 2;
      const double away = std::sqrt(mx * mx + my * my) - street.circle;
      out.look(greenness(ground, mx, my, away) > 0 ? "grass" : "ground");
      const Vec3 corners[4] = {at(xs[i], ys[k]), at(xs[i + 1], ys[k]), at(xs[i + 1], ys[k + 1]), at(xs[i], ys[k + 1])};
      out.quad(corners[0], corners[1], corners[2], corners[3]);
      if (k > 0 && !is_there(i, k - 1)) add_bank(corners[0], corners[1]);
      if (i + 1 < columns && !is_there(i + 1, k)) add_bank(corners[1], corners[2]);
      if (k + 1 < rows && !is_there(i, k + 1)) add_bank(corners[2], corners[3]);
      if (i > 0 && !is_there(i - 1, k)) add_bank(corners[3], corners[0]);
    }
}

}  // namespace

SurroundingMesh make_soil(const StreetSection& street, const RoughGround& ground, double reach) {
  const double far = reach + kBeyond;
  const std::vector<double> xs = joined(growing(0, -far), growing(0, far));
  MeshBuilder out;
  add_field(street, ground, xs, joined(growing(0, street.near_edge()), growing(0, far)), out);
  add_field(street, ground, xs, joined(growing(street.far_edge(), -far), {}), out);
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take_smooth(60));
  mesh.light_spacing = 1;
  return mesh;
}

// Blades in tufts, most of them where grass begins: it has no edge.
SurroundingMesh make_tufts(const StreetSection& street, const RoughGround& ground, double reach, RandomStream& random) {
  MeshBuilder out;
  out.look("leaves");
  const double far = std::min(reach, street.circle + 22);
  for (int i = 0; i < 9000; ++i) {
    const double x = random.uniform(-far, far), y = random.uniform(street.near_edge(), far), size = random.uniform(0.05, 0.16);
    const double away = std::sqrt(x * x + y * y) - street.circle;
    const double green = greenness(ground, x, y, away);
    const bool weed = random.uniform() < 0.04, edge = std::fabs(green) < 0.35;
    const bool there = random.uniform() < 0.25;
    if (away < 0.4 || !(weed || (green > -0.35 && (edge || there)))) continue;
    const Vec3 root(x, y, ground.height(x, y) - 0.01);
    for (int blade = 0; blade < 5; ++blade) {
      const Vec3 way = random.direction();
      const Vec3 tip = root + Vec3(way.x * size * 0.9, way.y * size * 0.9, size * random.uniform(0.5, 1));
      const Vec3 foot(root.x + way.x * 0.035, root.y + way.y * 0.035, root.z);
      const Vec3 side = normalized(Vec3(-way.y, way.x, 0.05)) * (0.007 + 0.05 * size);
      out.triangle(foot - side, foot + side, tip), out.triangle(foot + side, foot - side, tip);
    }
  }
  if (out.empty()) return {};
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 1.2, mesh.leafy = true;
  return mesh;
}

// Water that stands in hollows of the road: sheets on it, thicker than what runs off.
SurroundingMesh make_puddles(const StreetSection& street, double reach, double share, RandomStream& random) {
  MeshBuilder out;
  out.look("water");
  for (double x = -reach; x < reach; x += random.uniform(2.5, 6)) {
    const double side = random.below(2) ? 1.0 : -1.0, length = random.uniform(0.5, 2.2), width = random.uniform(0.25, 0.9);
    const bool gutter = random.uniform() < 0.55, there = random.uniform() < share;
    const double middle = gutter ? StreetSection::kHalf - 0.12 : random.uniform(0.6, 4.2);
    constexpr int kCorners = 22;
    std::vector<Vec3> rim;
    const double wave = random.uniform(0, 6), depth = random.uniform(0.006, 0.011);
    for (int i = 0; i < kCorners; ++i) {
      const portable::SinCos t = portable::sincos(2 * portable::kPi * i / kCorners);
      const double r = 1 + 0.22 * portable::sin(wave + 2 * 2 * portable::kPi * i / kCorners) + random.uniform(-0.13, 0.13);
      const double off = std::clamp(middle + width * r * t.sin, 0.1, StreetSection::kHalf - 0.01);
      rim.push_back({x + length * r * t.cos, street.middle() + side * off, road_height(off) + depth});
    }
    if (!there) continue;
    const Vec3 hub(x, street.middle() + side * std::min(middle, StreetSection::kHalf - 0.1),
                   road_height(std::min(middle, StreetSection::kHalf - 0.1)) + depth);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Vec3 &a = rim[i], &b = rim[(i + 1) % rim.size()];
      if (side > 0) out.triangle(hub, a, b);
      else out.triangle(hub, b, a);
    }
  }
  if (out.empty()) return {};
  SurroundingMesh mesh;
  TriangleMesh sheet = out.take();
  sheet.normals.assign(sheet.positions.size(), Vec3f(0, 0, 1));  // water is level
  mesh.levels.push_back(std::move(sheet));
  mesh.light_spacing = 0.7;
  return mesh;
}

// A ring of low hills, which no street ends before.
SurroundingMesh make_hills(const RoughGround& ground, double from) {
  constexpr int kSectors = 120;
  constexpr double kRings[] = {1, 1.6, 2.6, 4.2, 6.5, 9.5};
  MeshBuilder out;
  out.look("grass");
  const auto at = [&](int sector, double ring) {
    const portable::SinCos t = portable::sincos(2 * portable::kPi * sector / kSectors);
    const double r = from * ring, x = r * t.cos, y = r * t.sin;
    const double part = (ring - 1) / 8.5;
    const double rough = 0.5 + 0.5 * ground.noise(x, y, 700, 11) + 0.25 * ground.noise(x, y, 260, 12) + 0.1 * ground.noise(x, y, 90, 13);
    return Vec3(x, y, -0.4 + part * (28 + 80 * std::max(rough, 0.0)));
  };
  for (int i = 0; i < kSectors; ++i)
    for (std::size_t k = 0; k + 1 < std::size(kRings); ++k)
      out.quad(at(i, kRings[k]), at(i, kRings[k + 1]), at((i + 1) % kSectors, kRings[k + 1]), at((i + 1) % kSectors, kRings[k]));
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take_smooth(80));
  mesh.light_spacing = 60;
  return mesh;
}

}  // namespace rubble
