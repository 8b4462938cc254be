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

constexpr int kRings = 7, kSpokes = 26;
constexpr double kBuried = 0.0015;       // of its rim below the surface, and of all its underside; unit: m
constexpr double kSmallest = 0.06, kLargest = 0.34;  // radius; unit: m
constexpr double kRadiusPower = 1.2;           // larger radii than r: in proportion to r^-kRadiusPower
constexpr double kStep = 0.06;           // that the ground may rise or fall within a drift; as a share of its radius,
constexpr double kLeastStep = 0.02;      // and at least so much; unit: m
constexpr double kLowest = 0.08, kHighestShare = 0.24;  // height over radius
constexpr double kOffGround = 0.25;      // largest share of its places that may be in a wall or off an edge
constexpr double kApart = 0.6;           // least distance of two drifts, in radii of both

// A mound in polar coordinates: the height of the ground under each of its places and of the dust on it.
class Mound {
 public:
  Mound(const GrainGround& ground, const FineSite& site, RandomStream& random) : ground_(ground) {
    const double u = random.uniform(), ratio = portable::exp(-kRadiusPower * portable::log(kLargest / kSmallest));
    radius_ = kSmallest * portable::exp(-portable::log(1 - u * (1 - ratio)) / kRadiusPower);
    height_ = radius_ * random.uniform(kLowest, kHighestShare);
    // Its middle near the wall that it leans on.
    const double towards = std::max(0.0, site.wall - 0.25 * radius_);
    middle_ = site.point + site.to_wall * (site.wall < radius_ ? towards : 0);
    lift_ = std::min(0.7 * site.headroom, 0.3);
    for (double& wave : waves_) wave = random.uniform(0, 2 * portable::kPi);
  }

  double radius() const { return radius_; }
  const Vec3& middle() const { return middle_; }

  // Finds the ground. False where it would not stay.
  bool settle() {
    const auto below = find_below(ground_.queries, middle_ + Vec3(0, 0, lift_), lift_ + kStep);
    if (!below) return false;
    middle_ = below->point, host_ = below->piece, normal_ = below->normal;
    int off = 0;
    const double step = std::max(kLeastStep, kStep * radius_);
    for (int ring = 1; ring <= kRings; ++ring)
      for (int k = 0; k < kSpokes; ++k) {
        const Vec3 at = place(ring, k);
        const double level = middle_.z - (normal_.x * (at.x - middle_.x) + normal_.y * (at.y - middle_.y)) / normal_.z;
        const auto hit = find_below(ground_.queries, {at.x, at.y, level + lift_}, lift_ + step);
        const bool fits = hit && std::fabs(hit->point.z - level) < step;
        if (!hit && ring < kRings && is_over_edge(at, level, step)) return false;
        off += !fits;
        base_.push_back(fits ? hit->point.z : level - kBuried);
      }
    return off <= int(kOffGround * kRings * kSpokes);
  }

  FineSheet make_sheet() const {
    FineSheet sheet;
    sheet.kind = FineKind::dust, sheet.host = host_, sheet.surface = std::uint8_t(FineSurface::dust);
    const Pose host_from_world = world_from_host(ground_.pile, host_).inverse();
    std::vector<Vec3> tops{{middle_.x, middle_.y, middle_.z + height_}};
    for (int ring = 1; ring <= kRings; ++ring)
      for (int k = 0; k < kSpokes; ++k) tops.push_back(top(ring, k));
    for (const Vec3& p : tops) sheet.mesh.positions.push_back(Vec3f(host_from_world * p));
    add_underside(tops, host_from_world, sheet.mesh);
    add_triangles(sheet.mesh);
    set_normals(sheet.mesh);
    return sheet;
  }

 private:
  Vec3 place(int ring, int k) const {
    const double angle = 2 * portable::kPi * k / kSpokes;
    const auto [s, c] = portable::sincos(angle);
    const double uneven = 1 + 0.22 * portable::cos(2 * angle + waves_[0]) + 0.16 * portable::cos(3 * angle + waves_[1]) +
                          0.1 * portable::cos(5 * angle + waves_[2]) + 0.07 * portable::cos(8 * angle + waves_[3]);
    const double r = radius_ * uneven * ring / kRings;
    return {middle_.x + r * c, middle_.y + r * s, 0};
  }

  // In a wall there is something beside it; over an edge there is nothing for a long way.
  bool is_over_edge(const Vec3& at, double level, double step) const {
    return !ground_.queries.find_closest({at.x, at.y, level}, step);
  }

  Vec3 top(int ring, int k) const {
    const double t = double(ring) / kRings, fall = 1 - t * t;
    Vec3 p = place(ring, k);
    p.z = base_[std::size_t((ring - 1) * kSpokes + k)] + (ring == kRings ? -kBuried : height_ * fall * (0.4 + 0.6 * fall));
    return p;
  }

  // Below the ground, ring by ring as the top but for the rim, which both have.
  void add_underside(const std::vector<Vec3>& tops, const Pose& host_from_world, TriangleMesh& mesh) const {
    const auto inner = std::size_t(1 + (kRings - 1) * kSpokes);
    for (std::size_t i = 0; i < inner; ++i) {
      Vec3 p = tops[i];
      p.z = (i == 0 ? middle_.z : base_[i - 1]) - 2 * kBuried;
      mesh.positions.push_back(Vec3f(host_from_world * p));
    }
  }

  static void add_triangles(TriangleMesh& mesh) {
    constexpr std::uint32_t kTops = 1 + kRings * kSpokes;
    const auto over = [](int ring, int k) {
      return ring == 0 ? 0u : std::uint32_t(1 + (ring - 1) * kSpokes + k % kSpokes);
    };
    const auto under = [&](int ring, int k) { return ring == kRings ? over(ring, k) : kTops + over(ring, k); };
    for (int ring = 0; ring < kRings; ++ring)
      for (int k = 0; k < kSpokes; ++k) {
        mesh.triangles.push_back({over(ring, k), over(ring + 1, k), over(ring + 1, k + 1)});
        mesh.triangles.push_back({under(ring, k), under(ring + 1, k + 1), under(ring + 1, k)});
        if (ring == 0) continue;
        mesh.triangles.push_back({over(ring, k), over(ring + 1, k + 1), over(ring, k + 1)});
        mesh.triangles.push_back({under(ring, k), under(ring, k + 1), under(ring + 1, k + 1)});
      }
  }

  // Smooth over the top. The underside, which is never seen, has the same: where both meet, normals that
  // point against each other would have a mean of nothing.
  static void set_normals(TriangleMesh& mesh) {
    constexpr std::uint32_t kTops = 1 + kRings * kSpokes;
    mesh.normals.assign(mesh.positions.size(), {});
    for (const auto& t : mesh.triangles) {
      if (t[0] >= kTops || t[1] >= kTops || t[2] >= kTops) continue;
      const Vec3f& a = mesh.positions[t[0]];
      const Vec3f normal = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
      for (const std::uint32_t v : t) mesh.normals[v] += normal;
    }
    for (std::uint32_t i = 0; i < kTops; ++i) mesh.normals[i] = normalized(mesh.normals[i]);
    for (std::size_t i = kTops; i < mesh.normals.size(); ++i) mesh.normals[i] = mesh.normals[i - kTops];
  }

  const GrainGround& ground_;
  double radius_ = 0, height_ = 0, lift_ = 0;  // unit: m
  Vec3 middle_, normal_;
  int host_ = -1;
  std::array<double, 4> waves_{};
  std::vector<double> base_;  // by ring, then spoke, without the middle; unit: m
};

// Corners above all.
double calc_drift_weight(const FineSite& site) {
  constexpr double kOpen = 0.001, kFades = 0.3;
  return (kOpen + site.corner * site.corner * 4) * portable::exp(-site.away / kFades);
}

}  // namespace

void heap_drifts(const GrainGround& ground, int count, std::vector<FineSheet>& sheets) {
  std::vector<double> weights;
  double sum = 0;
  for (const FineSite& site : ground.sites) weights.push_back(calc_drift_weight(site)), sum += weights.back();
  if (!(sum > 0)) return;
  const WeightedChoice choice(weights);
  struct Tried {
    Vec3 middle;
    double radius = 0;
    std::optional<FineSheet> sheet;
  };
  std::vector<Tried> tried(std::size_t(count) * 8);
  parallel_for(tried.size(), ground.options.threads, [&](std::size_t i) {
    RandomStream random(ground.options.seed, "fines.dust." + std::to_string(i));
    const FineSite& site = ground.sites[std::size_t(choice.draw(random))];
    Mound mound(ground, site, random);
    if (mound.settle()) tried[i] = {mound.middle(), mound.radius(), mound.make_sheet()};
  });
  std::vector<const Tried*> kept;
  for (Tried& t : tried) {
    if (!t.sheet || int(kept.size()) >= count) continue;
    const auto near = [&](const Tried* other) {
      return distance(other->middle, t.middle) < kApart * (other->radius + t.radius);
    };
    if (std::any_of(kept.begin(), kept.end(), near)) continue;
    kept.push_back(&t);
    sheets.push_back(*t.sheet);
  }
}

}  // namespace rubble
