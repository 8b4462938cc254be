#include "kernel/fines/strands.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/fine_shapes.h"

namespace rubble {

double cosh_of(double x) { return 0.5 * (portable::exp(x) + portable::exp(-x)); }

double sinh_of(double x) {
  if (std::fabs(x) > 0.1) return 0.5 * (portable::exp(x) - portable::exp(-x));
  const double y = x * x;  // exp() less exp() would cancel
  return x * (1 + y / 6 * (1 + y / 20 * (1 + y / 42)));
}

Vec3 Catenary::at(double x) const {
  return from + along * x + Vec3(0, 0, a * cosh_of((x - x0) / a) + c);
}

// With r = sqrt(length^2 - rise^2) / span, sinh(u) = r u has one root u > 0; a = span / (2 u), and the lowest
// point is off the middle by a atanh(rise / length).
Catenary hang(const Vec3& from, const Vec3& to, double length) {
  const Vec3 level{to.x - from.x, to.y - from.y, 0};
  const double rise = to.z - from.z;
  Catenary curve;
  curve.from = from, curve.span = norm(level), curve.along = normalized(level);
  const double r = std::sqrt(std::max(0.0, length * length - rise * rise)) / curve.span;
  if (!(curve.span > 0) || !(r > 1)) throw std::invalid_argument("hang: too short for its ends, or upright");
  double low = 0, high = 1;
  while (sinh_of(high) < r * high) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double u = 0.5 * (low + high);
    (sinh_of(u) < r * u ? low : high) = u;
  }
  curve.a = curve.span / (low + high);
  curve.x0 = 0.5 * curve.span - curve.a * 0.5 * portable::log((length + rise) / (length - rise));
  curve.c = -curve.a * cosh_of(-curve.x0 / curve.a);
  return curve;
}

namespace {

constexpr int kTriesEach = 1500;
constexpr double kShortest = 0.6, kLongest = 4.5;  // between the ends; unit: m
constexpr double kLeastSpan = 0.3;                 // of that, level; unit: m
constexpr double kHeld = 0.012;                    // of an end in what holds it; unit: m
constexpr double kFree = 0.04;                     // near an end, its holder may be as near as it likes; unit: m
constexpr double kAir = 0.004;                     // between a strand and all else; unit: m
constexpr double kEye = 0.6;                       // highest place above a site that anchors are looked for from
constexpr double kLookDown = 0.3;                  // of a unit direction that has any, at most
constexpr double kSight = 3;                       // farthest anchor from there; unit: m
constexpr double kRing = 0.05;                     // between rings of a tube; unit: m

struct Make {
  double radius_min, radius_max;  // unit: m
  double slack_min, slack_max;    // of the length, over the distance of the ends
  int sides;
  std::array<FineSurface, 3> surfaces;  // one of them
};

Make make_of(FineKind kind) {
  if (kind == FineKind::pipe) return {0.007, 0.02, 0.001, 0.012, 10, {FineSurface::galvanised, FineSurface::rust, FineSurface::rust}};
  return {0.0025, 0.007, 0.01, 0.35, 6, {FineSurface::rubber, FineSurface::rubber, FineSurface::rubber}};
}

struct Strand {
  Catenary curve;
  double radius = 0;  // unit: m
  int host = -1;      // what holds its first end
};

class Hanger {
 public:
  Hanger(const GrainGround& ground, FineKind kind, RandomStream& random)
      : ground_(ground), make_(make_of(kind)), random_(random) {}

  std::optional<Strand> find() {
    const double radius = random_.uniform(make_.radius_min, make_.radius_max);
    const double slack = make_.slack_min + (make_.slack_max - make_.slack_min) * square(random_.uniform());
    const FineSite& site = ground_.sites[random_.below(ground_.sites.size())];
    const Vec3 eye = site.point + Vec3(0, 0, std::min(0.7 * site.headroom, kEye) * random_.uniform(0.3, 1));
    const auto a = find_anchor(eye), b = find_anchor(eye);
    if (!a || !b) return std::nullopt;
    const double apart = distance(a->point, b->point);
    const Vec3 level{b->point.x - a->point.x, b->point.y - a->point.y, 0};
    if (apart < kShortest || apart > kLongest || norm(level) < kLeastSpan) return std::nullopt;
    const Vec3 from = a->point - a->normal * kHeld, to = b->point - b->normal * kHeld;
    const double span = distance(from, to);
    Strand strand{hang(from, to, span * (1 + slack)), radius, ground_.host_of(a->piece)};
    if (!is_free(strand)) return std::nullopt;
    return strand;
  }

 private:
  static double square(double x) { return x * x; }

  // On a piece, in any direction but steeply down.
  std::optional<RayHit> find_anchor(const Vec3& eye) {
    Vec3 way = random_.direction();
    way.z = std::fabs(way.z) - kLookDown;
    const auto hit = ground_.queries.cast_ray(eye, way, kSight);
    const bool outside = hit && dot(hit->normal, normalized(way)) < -0.2;
    return outside && hit->piece != kGroundPiece ? hit : std::nullopt;
  }

  bool is_free(const Strand& strand) const {
    const Catenary& curve = strand.curve;
    const double steps = std::max(8.0, std::ceil(curve.span / 0.04));
    const Vec3 ends[2] = {curve.at(0), curve.at(curve.span)};
    Vec3 before = ends[0];
    for (int i = 1; i <= int(steps); ++i) {
      const Vec3 here = curve.at(curve.span * i / steps);
      const double to_end = std::min(distance(here, ends[0]), distance(here, ends[1]));
      const double from_end = std::min(distance(before, ends[0]), distance(before, ends[1]));
      const bool held = std::min(to_end, from_end) < kFree;
      if (to_end > kFree && ground_.queries.find_closest(here, strand.radius + kAir)) return false;
      if (!held && ground_.queries.cast_ray(before, here - before, distance(here, before))) return false;
      before = here;
    }
    // It meets no surface on the way, so it is outside of everything if it is so in its middle.
    return ground_.queries.clearance(curve.at(0.5 * curve.span), 1) > 0;
  }

  const GrainGround& ground_;
  Make make_;
  RandomStream& random_;
};

Vec3 tangent_of(const Catenary& curve, double x) {
  return normalized(curve.along + Vec3(0, 0, sinh_of((x - curve.x0) / curve.a)));
}

// Rings about the curve, which stays in an upright plane: its side does not turn.
TriangleMesh make_tube(const Strand& strand, int sides, const Pose& host_from_world) {
  const Catenary& curve = strand.curve;
  const int rings = std::max(8, int(std::ceil(curve.span / kRing)));
  const Vec3 side = cross(Vec3(0, 0, 1), curve.along);
  TriangleMesh mesh;
  const auto add = [&](const Vec3& p, const Vec3& n) {
    mesh.positions.push_back(Vec3f(host_from_world * p)), mesh.normals.push_back(Vec3f(host_from_world.rotation.rotate(n)));
  };
  for (int i = 0; i <= rings; ++i) {
    const double x = curve.span * i / rings;
    const Vec3 middle = curve.at(x), up = cross(tangent_of(curve, x), side);
    for (int k = 0; k < sides; ++k) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * k / sides);
      const Vec3 out = side * c + up * s;
      add(middle + out * strand.radius, out);
    }
  }
  const auto at = [sides](int ring, int k) { return std::uint32_t(ring * sides + k % sides); };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  for (int k = 1; k + 1 < sides; ++k) {
    mesh.triangles.push_back({at(0, 0), at(0, k + 1), at(0, k)});
    mesh.triangles.push_back({at(rings, 0), at(rings, k), at(rings, k + 1)});
  }
  return mesh;
}

}  // namespace

void hang_strands(const GrainGround& ground, FineKind kind, int count, std::vector<FineSheet>& sheets) {
  if (ground.sites.empty()) return;
  const Make make = make_of(kind);
  for (int i = 0; i < count; ++i) {
    RandomStream random(ground.options.seed, "fines." + fine_names()[std::size_t(kind)] + "." + std::to_string(i));
    Hanger hanger(ground, kind, random);
    std::optional<Strand> strand;
    for (int n = 0; n < kTriesEach && !strand; ++n) strand = hanger.find();
    if (!strand) return;  // no room for the next one either, or hardly
    FineSheet sheet;
    sheet.kind = kind, sheet.host = strand->host, sheet.surface = std::uint8_t(make.surfaces[random.below(make.surfaces.size())]);
    sheet.mesh = make_tube(*strand, make.sides, world_from_host(ground.pile, strand->host).inverse());
    sheets.push_back(std::move(sheet));
  }
}

}  // namespace rubble
