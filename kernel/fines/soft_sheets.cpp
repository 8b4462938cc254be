#include "kernel/fines/grains.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/fines/resting.h"
#include "kernel/geometry/fine_shapes.h"

namespace rubble {
namespace {

constexpr double kPaperThick = 0.0004, kClothThick = 0.002;  // unit: m
constexpr double kPaperGap = 0.012;   // below a part of a stiff sheet; unit: m
constexpr double kPoked = 0.0015;     // that a bump may reach through paper; unit: m
constexpr double kLoose = 0.0003;     // of a sheet above what it lies on; unit: m
constexpr double kLongestFall = 0.2;  // of a corner of cloth below its middle; unit: m
constexpr int kTriesEachSheet = 12;
constexpr int kPaperCells = 6, kClothCells = 18;  // along a side

struct Dropped {
  FineSheet sheet;
  Vec3 centre;        // in the world; unit: m
  double radius = 0;  // unit: m
};

// A grid of (n + 1)^2 places, row by row.
struct SheetGrid {
  int n = 1;
  std::vector<Vec3> places;  // of its lower side, in the world; unit: m

  std::uint32_t at(int i, int j) const { return std::uint32_t(j * (n + 1) + i); }
};

// Both sides and the edge between them. Normals are those of a smooth sheet.
TriangleMesh make_mesh(const SheetGrid& grid, double thick, const Pose& host_from_world) {
  const int n = grid.n;
  const auto count = std::uint32_t(grid.places.size());
  TriangleMesh mesh;
  std::vector<Vec3> normals;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const Vec3 x = grid.places[grid.at(std::min(i + 1, n), j)] - grid.places[grid.at(std::max(i - 1, 0), j)];
      const Vec3 y = grid.places[grid.at(i, std::min(j + 1, n))] - grid.places[grid.at(i, std::max(j - 1, 0))];
      normals.push_back(normalized(cross(x, y)));
    }
  for (const double side : {0.0, 1.0})
    for (std::uint32_t i = 0; i < count; ++i) {
      mesh.positions.push_back(Vec3f(host_from_world * (grid.places[i] + normals[i] * (side * thick))));
      mesh.normals.push_back(Vec3f(host_from_world.rotation.rotate(normals[i] * (2 * side - 1))));
    }
  const auto quad = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::uint32_t a = grid.at(i, j), b = grid.at(i + 1, j), c = grid.at(i + 1, j + 1), d = grid.at(i, j + 1);
      quad(count + a, count + b, count + c, count + d);
      quad(a, d, c, b);
    }
  const auto edge = [&](std::uint32_t a, std::uint32_t b) {
    const auto first = std::uint32_t(mesh.positions.size());
    const std::array<std::uint32_t, 4> corners{a, b, count + b, count + a};
    for (const std::uint32_t corner : corners) mesh.positions.push_back(Vec3f(mesh.positions[corner]));
    const Vec3f out = normalized(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[count + a] - mesh.positions[a]));
    mesh.normals.insert(mesh.normals.end(), corners.size(), out);
    quad(first, first + 1, first + 2, first + 3);
  };
  for (int i = 0; i < n; ++i) {
    edge(grid.at(i, 0), grid.at(i + 1, 0)), edge(grid.at(n, i), grid.at(n, i + 1));
    edge(grid.at(n - i, n), grid.at(n - i - 1, n)), edge(grid.at(0, n - i), grid.at(0, n - i - 1));
  }
  return mesh;
}

// Half sides of a sheet, and how far its four corners are pulled in where it is torn.
struct Cut {
  double x = 0, y = 0;  // unit: m
  std::array<double, 4> torn{};

  // u, v: -1 to 1.
  Vec3 place(double u, double v) const {
    const std::array<double, 4> weight{(1 - u) * (1 - v) / 4, (1 + u) * (1 - v) / 4, (1 + u) * (1 + v) / 4,
                                       (1 - u) * (1 + v) / 4};
    double in = 1;
    for (std::size_t i = 0; i < 4; ++i) in -= weight[i] * torn[i];
    return {u * x * in, v * y * in, 0};
  }
};

Cut draw_paper(RandomStream& random) {
  const double size = random.uniform(), wide = random.uniform(0.3, 1), long_side = random.uniform(0.03, 0.09);
  Cut cut{0.105, 0.1485, {}};                       // ISO 216: A4
  if (size > 0.2) cut.x = 0.074, cut.y = 0.105;    // A5
  if (size > 0.4) cut.y = long_side, cut.x = wide * long_side;
  for (double& t : cut.torn) t = random.uniform() * (size > 0.4 ? 0.5 : 0.0);
  return cut;
}

Cut draw_cloth(RandomStream& random) {
  const double side = random.uniform(0.12, 0.38);
  Cut cut{side, side * random.uniform(0.4, 0.9), {}};
  for (double& t : cut.torn) t = random.uniform(0, 0.45);
  return cut;
}

class Dropper {
 public:
  Dropper(const GrainGround& ground, FineKind kind) : ground_(ground), kind_(kind) {}

  std::optional<Dropped> drop(const FineSite& site, RandomStream& random) const {
    const bool paper = kind_ == FineKind::paper;
    const Cut cut = paper ? draw_paper(random) : draw_cloth(random);
    const double yaw = random.uniform(-portable::kPi, portable::kPi);
    const double lift = std::min(0.7 * site.headroom, 0.3);
    const auto below = find_below(ground_.queries, site.point + Vec3(0, 0, lift), lift + 0.05);
    if (!below) return std::nullopt;
    SheetGrid grid;
    grid.n = paper ? kPaperCells : kClothCells;
    const bool lies = paper ? lay_paper(cut, *below, yaw, random, grid) : drape(cut, *below, yaw, lift, random, grid);
    if (!lies) return std::nullopt;
    Dropped dropped;
    dropped.sheet.kind = kind_, dropped.sheet.host = ground_.host_of(below->piece);
    dropped.sheet.surface = std::uint8_t(paper ? FineSurface::paper : FineSurface::fabric);
    dropped.sheet.mesh = make_mesh(grid, paper ? kPaperThick : kClothThick,
                                   world_from_host(ground_.pile, dropped.sheet.host).inverse());
    dropped.centre = below->point, dropped.radius = 0.8 * std::max(cut.x, cut.y);
    return dropped;
  }

 private:
  // A plane on the highest of what is below, with one corner or edge that curls up.
  bool lay_paper(const Cut& cut, const RayHit& below, double yaw, RandomStream& random, SheetGrid& grid) const {
    const double most = random.uniform(), curl = most * random.uniform() * 0.5;
    const double way = random.uniform(-portable::kPi, portable::kPi);
    const auto support = find_support(ground_.queries, below, 0.8 * std::min(cut.x, cut.y), yaw, kPaperGap);
    if (!support) return false;
    const Tangents t = make_tangents(support->normal, yaw);
    const auto [s, c] = portable::sincos(way);
    for (int j = 0; j <= grid.n; ++j)
      for (int i = 0; i <= grid.n; ++i) {
        const double u = 2.0 * i / grid.n - 1, v = 2.0 * j / grid.n - 1;
        const Vec3 flat = cut.place(u, v);
        const double out = std::max(0.0, c * u + s * v - 0.4);
        const Vec3 p = support->point + t.x * flat.x + t.y * flat.y +
                       support->normal * (kLoose + curl * out * out * cut.x);
        const auto hit = ground_.queries.cast_ray(p + support->normal * 0.05, -support->normal, 0.05 - kPoked);
        if (hit) return false;
        grid.places.push_back(p);
      }
    return true;
  }

  // Every place on what is below it, and where that falls away, as far as the sheet bends.
  bool drape(const Cut& cut, const RayHit& below, double yaw, double lift, RandomStream& random,
             SheetGrid& grid) const {
    const Tangents t = make_tangents({0, 0, 1}, yaw);
    const double fold = random.uniform(0.004, 0.014), waves = random.uniform(9, 22), skew = random.uniform(-1, 1);
    std::vector<double> floor;
    for (int j = 0; j <= grid.n; ++j)
      for (int i = 0; i <= grid.n; ++i) {
        const double u = 2.0 * i / grid.n - 1, v = 2.0 * j / grid.n - 1;
        const Vec3 flat = cut.place(u, v);
        Vec3 p = below.point + t.x * flat.x + t.y * flat.y;
        const auto hit = ground_.queries.cast_ray(p + Vec3(0, 0, lift), {0, 0, -1}, lift + kLongestFall);
        if (!hit || hit->normal.z <= 0) return false;
        const double ridge = portable::sin(waves * (flat.x + skew * flat.y) + 3 * portable::sin(6 * (flat.y + flat.x)));
        floor.push_back(hit->point.z + kLoose);
        p.z = floor.back() + fold * std::max(0.0, ridge);
        grid.places.push_back(p);
      }
    bend(floor, grid);
    return true;
  }

  // Cloth spans hollows that are narrower than it bends; each round evens it out, but never into what is below.
  static void bend(const std::vector<double>& floor, SheetGrid& grid) {
    constexpr int kTimes = 10;
    const int n = grid.n;
    for (int round = 0; round < kTimes; ++round) {
      const std::vector<Vec3> was = grid.places;
      const auto height = [&](int i, int j) {
        return was[grid.at(std::clamp(i, 0, n), std::clamp(j, 0, n))].z;
      };
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          const double mean = 0.25 * (height(i - 1, j) + height(i + 1, j) + height(i, j - 1) + height(i, j + 1));
          double& z = grid.places[grid.at(i, j)].z;
          z = std::max(floor[grid.at(i, j)], 0.6 * z + 0.4 * mean);
        }
    }
  }

  const GrainGround& ground_;
  FineKind kind_;
};

}  // namespace

void drop_sheets(const GrainGround& ground, FineKind kind, int count, RoomForFines& room,
                 std::vector<FineSheet>& sheets) {
  const FinePatches patches(ground.options.seed + 1);
  std::vector<double> weights;
  double sum = 0;
  for (const FineSite& site : ground.sites) {
    const double near = portable::exp(-site.away / 0.4);
    weights.push_back(near * patches.at(site.point)), sum += weights.back();
  }
  if (!(sum > 0)) return;
  const WeightedChoice choice(weights);
  const Dropper dropper(ground, kind);
  std::vector<std::optional<Dropped>> dropped(std::size_t(count) * kTriesEachSheet);
  parallel_for(dropped.size(), ground.options.threads, [&](std::size_t i) {
    RandomStream random(ground.options.seed, "fines." + fine_names()[std::size_t(kind)] + "." + std::to_string(i));
    dropped[i] = dropper.drop(ground.sites[std::size_t(choice.draw(random))], random);
  });
  int left = count;
  for (std::optional<Dropped>& d : dropped)
    if (left > 0 && d && room.take(d->centre, d->radius)) sheets.push_back(std::move(d->sheet)), --left;
}

}  // namespace rubble
