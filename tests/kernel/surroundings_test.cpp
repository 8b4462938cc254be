// What stands about a pile: drawn by the seed alone, clear of the pile, with the measures of real streets.
#include "kernel/surroundings/make_surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/queries/queries.h"

namespace rubble {
namespace surroundings_test {

const Circle kPile{3, -2, 6};

SurroundingsSpec street() {
  SurroundingsSpec spec;
  spec.type = SurroundingsType::street;
  spec.reach = 60;
  return spec;
}

Surroundings make(const SurroundingsSpec& spec, std::uint64_t seed = 1, bool dark = false, double wetness = 0) {
  return make_surroundings(spec, seed, kPile, dark, wetness);
}

std::uint64_t hash_of(const Surroundings& s) {
  StateHash hash;
  for (const auto& mesh : s.meshes)
    for (const TriangleMesh& level : mesh->levels) {
      for (const Vec3f& p : level.positions)
        for (const float c : {p.x, p.y, p.z}) hash.add(double(c));
      for (const std::uint8_t surface : level.surfaces) hash.add(int(surface));
    }
  for (const SurroundingThing& thing : s.things) {
    const Pose& pose = thing.world_from_mesh;
    hash.add(int(thing.kind)), hash.add(int(thing.mesh)), hash.add(thing.scale);
    for (const double c : {pose.translation.x, pose.translation.y, pose.translation.z, pose.rotation.w, pose.rotation.z})
      hash.add(c);
  }
  return hash.digest();
}

int count(const Surroundings& s, SurroundingKind kind) {
  return int(std::count_if(s.things.begin(), s.things.end(), [&](const SurroundingThing& t) { return t.kind == kind; }));
}

const TriangleMesh& finest(const Surroundings& s, const SurroundingThing& thing) {
  return s.meshes[thing.mesh]->levels.front();
}

const SurroundingThing& first(const Surroundings& s, SurroundingKind kind) {
  return *std::find_if(s.things.begin(), s.things.end(), [&](const SurroundingThing& t) { return t.kind == kind; });
}

TEST(Surroundings, FollowFromTheSeedAlone) {
  EXPECT_EQ(hash_of(make(street(), 5)), hash_of(make(street(), 5)));
  std::set<std::uint64_t> hashes;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) hashes.insert(hash_of(make(street(), seed)));
  EXPECT_EQ(hashes.size(), 5u);
  EXPECT_TRUE(make(SurroundingsSpec{}).things.empty());
}

// Corners and middles of edges: a triangle between corners outside the circle might still reach into it.
TEST(Surroundings, KeepClearOfThePile) {
  for (const double turn : {0.0, 130.0}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SurroundingsSpec spec = street();
      spec.turn_deg = turn, spec.clearance = 3, spec.trees = spec.vehicles = 1;
      const Surroundings s = make(spec, seed, false, 1);
      double nearest = 1e9;
      for (const SurroundingThing& thing : s.things) {
        const TriangleMesh& mesh = finest(s, thing);
        for (const auto& t : mesh.triangles)
          for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a(mesh.positions[t[k]]), b(mesh.positions[t[(k + 1) % 3]]);
            for (const Vec3& p : {a, (a + b) * 0.5}) {
              const Vec3 w = thing.world_from_mesh * (p * thing.scale);
              nearest = std::min(nearest, std::hypot(w.x - kPile.x, w.y - kPile.y));
            }
          }
      }
      EXPECT_GT(nearest, kPile.radius + spec.clearance - 0.1) << "seed " << seed << ", turned by " << turn;
      EXPECT_LT(nearest, kPile.radius + spec.clearance + 1.5) << "the ground begins far away";
    }
  }
}

TEST(Surroundings, HaveTheMeasuresOfAStreet) {
  const Surroundings s = make(street(), 2);
  const Aabb road = finest(s, first(s, SurroundingKind::road)).bounds();
  EXPECT_NEAR(road.max.y - road.min.y, 6.5 + 2 * 2.0, 0.01);  // lanes and parking, RASt 06
  const Aabb kerb = finest(s, first(s, SurroundingKind::kerb)).bounds();
  EXPECT_NEAR(kerb.max.z - 0.02, 0.12, 0.006);  // above the gutter
  const Aabb pavement = finest(s, first(s, SurroundingKind::pavement)).bounds();
  EXPECT_NEAR((pavement.max.y - pavement.min.y - (road.max.y - road.min.y)) / 2, 2.5, 0.01);
  for (const SurroundingThing& thing : s.things) {
    const Aabb box = finest(s, thing).bounds();
    if (thing.kind == SurroundingKind::vehicle) {
      EXPECT_NEAR(box.max.x - box.min.x, 4.5, 0.6);
      EXPECT_NEAR(box.max.z, 1.7, 0.35);
      EXPECT_NEAR(box.min.z, 0, 0.01) << "wheels on the ground";
    }
    if (thing.kind == SurroundingKind::street_lamp) {
      EXPECT_NEAR(box.max.z, 7, 0.2);
    }
    if (thing.kind == SurroundingKind::tree) {
      EXPECT_NEAR(box.max.z * thing.scale, 7.5, 4);
    }
  }
}

TEST(Surroundings, BuildingsHaveTheStoreysThatWereAskedFor) {
  SurroundingsSpec spec = street();
  spec.storeys = {3, 3};
  const Surroundings s = make(spec, 4);
  ASSERT_GT(count(s, SurroundingKind::building), 8);
  std::set<float> widths;
  for (const SurroundingThing& thing : s.things) {
    if (thing.kind != SurroundingKind::building) continue;
    const TriangleMesh& mesh = finest(s, thing);
    widths.insert(mesh.bounds().max.x > 0 ? float(mesh.bounds().max.x) : 0.0f);
    // A ground floor of 3.4 to 4.1 m and two of 2.75 to 3.2 m, with at most a roof of half the depth and chimneys.
    EXPECT_GT(mesh.bounds().max.z, 8.9);
    EXPECT_LT(mesh.bounds().max.z, 10.5 + 8);
  }
  EXPECT_GT(widths.size(), 8u) << "buildings are all alike";
}

TEST(Surroundings, SharesOfPlacesAreKept) {
  SurroundingsSpec spec = street();
  spec.trees = spec.vehicles = 0;
  const Surroundings bare = make(spec, 3);
  EXPECT_EQ(count(bare, SurroundingKind::tree), 0);
  EXPECT_EQ(count(bare, SurroundingKind::vehicle), 0);
  EXPECT_EQ(count(bare, SurroundingKind::puddle), 0);
  spec.trees = spec.vehicles = 1;
  const Surroundings full = make(spec, 3, false, 1);
  EXPECT_GT(count(full, SurroundingKind::tree), 10);
  EXPECT_GT(count(full, SurroundingKind::vehicle), 15);
  EXPECT_EQ(count(full, SurroundingKind::puddle), 1);
  // What is drawn for one purpose changes nothing else.
  EXPECT_EQ(count(bare, SurroundingKind::building), count(full, SurroundingKind::building));
  EXPECT_EQ(finest(bare, first(bare, SurroundingKind::building)).positions.size(),
            finest(full, first(full, SurroundingKind::building)).positions.size());
}

TEST(Surroundings, RainChangesNoOtherThing) {
  const Surroundings dry = make(street(), 3), wet = make(street(), 3, false, 1);
  ASSERT_EQ(wet.things.size(), dry.things.size() + 1);
  for (std::size_t i = 0; i < dry.things.size(); ++i) EXPECT_EQ(dry.things[i].kind, wet.things[i].kind) << i;
  EXPECT_EQ(wet.things.back().kind, SurroundingKind::puddle);
}

// Lit windows by their look; area by area would be the same.
TEST(Surroundings, LampsAndWindowsAreLitInTheDark) {
  const auto shares = [](const Surroundings& s) {
    double lit = 0, panes = 0;
    for (const SurroundingThing& thing : s.things) {
      if (thing.kind != SurroundingKind::building) continue;
      const TriangleMesh& mesh = finest(s, thing);
      for (const std::uint8_t surface : mesh.surfaces) {
        lit += mesh.surface_names[surface] == "window_lit";
        panes += mesh.surface_names[surface] == "pane" || mesh.surface_names[surface] == "window_lit";
      }
    }
    return lit / panes;
  };
  SurroundingsSpec spec = street();
  spec.lit_windows = 0.4;
  const Surroundings day = make(spec), night = make(spec, 1, true);
  EXPECT_FALSE(day.lit);
  EXPECT_TRUE(night.lit);
  EXPECT_EQ(shares(day), 0);
  EXPECT_NEAR(shares(night), 0.42, 0.06);
  spec.lamps = StreetLampState::on;
  EXPECT_TRUE(make(spec).lit);
  spec.lamps = StreetLampState::off;
  EXPECT_FALSE(make(spec, 1, true).lit);
  ASSERT_GE(night.lamps.size(), 6u);
  for (std::size_t i = 0; i + 1 < night.lamps.size(); ++i) {
    const auto away = [](const Vec3& p) { return norm(p - Vec3(kPile.x, kPile.y, 0)); };
    EXPECT_LE(away(night.lamps[i]), away(night.lamps[i + 1]) + 1e-9);
  }
}

TEST(Surroundings, AreAnsweredByQueries) {
  PileState pile;
  SurroundingsSpec spec = street();
  pile.surroundings = std::make_shared<const Surroundings>(make(spec, 6));
  const PileQueries queries(pile, {});
  // From above onto the middle of the street: the crown of the road, 0.15 m high to within its bumps.
  const double middle = kPile.y - (kPile.radius + spec.clearance) - 0.5 - 2.5 - 5.25;
  const auto road = queries.cast_ray({kPile.x + 1.3, middle + 0.4, 3}, {0, 0, -1}, 10);
  ASSERT_TRUE(road);
  EXPECT_GE(road->piece, kFirstSurrounding);
  EXPECT_NEAR(road->point.z, 0.145, 0.02);
  // Across the street towards the far fronts: something stands there.
  const auto front = queries.cast_ray({kPile.x, middle, 2}, {0, -1, 0}, 60);
  ASSERT_TRUE(front);
  EXPECT_NEAR(front->distance, 5.25 + 2.5, 2.5);
  EXPECT_EQ(queries.cast_ray({kPile.x, kPile.y, 2}, {0, 0, -1}, 10)->piece, kGroundPiece);
}

TEST(Surroundings, CircleHoldsAllPieces) {
  TriangleMesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}};
  PileState pile;
  for (const double x : {-4.0, 6.0}) {
    PieceState piece;
    piece.world_from_body.translation = {x, 2, 0};
    piece.status = PieceStatus::resting;
    pile.pieces.push_back(piece);
  }
  PieceState lost;
  lost.world_from_body.translation = {900, 0, 0};
  lost.status = PieceStatus::lost;
  pile.pieces.push_back(lost);
  const Circle circle = find_pile_circle(pile, {&mesh});
  EXPECT_DOUBLE_EQ(circle.x, 1);
  EXPECT_DOUBLE_EQ(circle.y, 2);
  EXPECT_NEAR(circle.radius, std::hypot(6, 1), 1e-9);
}

}  // namespace surroundings_test
}  // namespace rubble
