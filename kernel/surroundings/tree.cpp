#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/surroundings/parts.h"

namespace rubble {

namespace {

struct Clump {  // of leaves, about the end of a branch
  Vec3 middle;
  double radius = 1;  // unit: m
};

// Leaves on the outside of a clump, where the light is.
void add_leaves(const std::vector<Clump>& clumps, int count, double size, RandomStream& random, MeshBuilder& out) {
  out.look("leaves");
  double area = 0;
  for (const Clump& c : clumps) area += c.radius * c.radius;
  for (const Clump& c : clumps) {
    const int here = int(count * c.radius * c.radius / area);
    for (int i = 0; i < here; ++i) {
      const Vec3 way = random.direction();
      const double in = 0.45 * random.uniform(), r = c.radius * (1 - in * random.uniform());
      const Vec3 at = c.middle + Vec3(way.x, way.y, way.z * 0.8) * r;
      // Leaves look up and outwards, each its own way.
      const Vec3 normal = normalized(way * 0.7 + Vec3(0, 0, 0.55) + random.direction() * 0.9);
      const Vec3 side = normalized(cross(normal, random.direction()));
      const Vec3 along = cross(normal, side);
      const double s = size * random.uniform(0.65, 1.25);
      const Vec3 a = at - along * (0.5 * s), b = at + side * (0.3 * s) - normal * (0.05 * s), c2 = at + along * (0.5 * s),
                 d = at - side * (0.3 * s) - normal * (0.05 * s);
      out.leaf(a, b, c2, d);
    }
  }
}

// A bent branch of three pieces; its end.
Vec3 add_branch(const Vec3& from, const Vec3& way, double length, double radius, RandomStream& random,
                MeshBuilder& out) {
  Vec3 at = from, heading = way;
  for (int i = 0; i < 3; ++i) {
    const Vec3 next = at + heading * (length / 3);
    out.tube(at - heading * (0.5 * radius), next, radius * (1 - 0.25 * i), radius * (0.75 - 0.25 * i) + 0.006, 6);
    at = next;
    heading = normalized(heading + random.direction() * 0.25 + Vec3(0, 0, 0.12));
  }
  return at;
}

}  // namespace

SurroundingMesh make_tree(double height, RandomStream& random) {
  MeshBuilder wood;
  wood.look("asphalt");  // as dark and as rough as bark
  const double radius = 0.019 * height + 0.03, bole = height * random.uniform(0.28, 0.36);
  const double aside = random.uniform(-0.05, 0.05), ahead = random.uniform(-0.05, 0.05);
  Vec3 lean = normalized(Vec3(ahead, aside, 1));
  const Vec3 fork = lean * bole;
  wood.tube(Vec3(0, 0, -0.4), Vec3(0, 0, 0.12), radius * 1.5, radius * 1.12, 9);
  wood.tube(Vec3(0, 0, 0.1), fork, radius * 1.12, radius * 0.85, 9);
  std::vector<Clump> clumps;
  const double crown = height - bole, spread = height * random.uniform(0.26, 0.36);
  const int limbs = 6 + int(random.below(3));
  const double first = random.uniform(0, 2 * portable::kPi);
  for (int i = 0; i < limbs; ++i) {
    const portable::SinCos t = portable::sincos(first + 2.4 * i);
    const double rise = 0.35 + 0.65 * i / (limbs - 1);
    const double out = spread * (1.05 - 0.75 * rise) * random.uniform(0.8, 1.1);
    const Vec3 end(fork.x + t.cos * out, fork.y + t.sin * out, bole + crown * (0.12 + 0.66 * rise));
    const Vec3 start = fork + lean * (crown * 0.35 * rise);
    const Vec3 tip = add_branch(start, normalized(end - start), distance(start, end), radius * (0.5 - 0.25 * rise),
                                random, wood);
    clumps.push_back({tip, spread * random.uniform(0.42, 0.58)});
    const Vec3 twig = start + (tip - start) * 0.6;
    const Vec3 more = add_branch(twig, normalized(Vec3(-t.sin, t.cos, 0.5) * (i % 2 ? 1.0 : -1.0)), spread * 0.5,
                                 radius * 0.18, random, wood);
    clumps.push_back({more, spread * random.uniform(0.32, 0.45)});
  }
  wood.tube(fork, fork + lean * (crown * 0.62), radius * 0.8, radius * 0.15, 7);
  clumps.push_back({fork + lean * (crown * 0.66), spread * 0.55});
  SurroundingMesh out;
  const int counts[] = {5200, 1300, 330};
  const double sizes[] = {0.2, 0.4, 0.78};
  for (int level = 0; level < 3; ++level) {
    MeshBuilder leaves = wood;
    RandomStream of_level(random.next(), "leaves");
    add_leaves(clumps, counts[level], sizes[level] * std::sqrt(height / 8), of_level, leaves);
    out.levels.push_back(leaves.take());
  }
  out.light_spacing = 1.0, out.leafy = true;
  return out;
}

SurroundingMesh make_hedge(double length, double height, RandomStream& random) {
  std::vector<Clump> clumps;
  for (double x = 0.4; x < length; x += 0.55)
    for (const double z : {0.3, 0.75})
      clumps.push_back({{x + random.uniform(-0.15, 0.15), random.uniform(-0.1, 0.1), height * z},
                        height * random.uniform(0.33, 0.45)});
  SurroundingMesh out;
  for (const double part : {1.0, 0.3}) {
    MeshBuilder builder;
    builder.look("leaves");
    builder.box({0.1, -0.22, -0.3}, {length - 0.1, 0.22, height * 0.85});
    RandomStream of_level(random.next(), "leaves");
    add_leaves(clumps, int(190 * length * part), part < 1 ? 0.24 : 0.13, of_level, builder);
    out.levels.push_back(builder.take());
  }
  out.light_spacing = 0.8, out.leafy = true;
  return out;
}

}  // namespace rubble
