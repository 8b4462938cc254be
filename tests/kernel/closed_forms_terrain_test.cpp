// Pieces dropped on spikes come to lie on them, never below.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_forms.h"
#include "kernel/base/random.h"

namespace rubble {
namespace closed_forms_terrain_test {

using namespace testing;

// Spikes up to 0.8 m high on a grid of 0.4 m, which goes down to z = 0.2.
struct Spikes {
  static constexpr int kCells = 30;
  static constexpr double kSpacing = 0.4, kHalf = 0.5 * kCells * kSpacing;
  std::vector<double> heights;

  explicit Spikes(std::uint64_t seed) {
    RandomStream random(seed, "spikes");
    for (int i = 0; i < (kCells + 1) * (kCells + 1); ++i) {
      const double height = random.uniform(0, 1);
      heights.push_back(1 + 0.8 * height * height * height);
    }
  }
  double corner(int column, int row) const {
    return heights[std::size_t(row * (kCells + 1) + column)];
  }
  PieceType type() const {
    return terrain_type(2 * kHalf, kSpacing, [this](double x, double y) {
      return corner(int(std::lround((x + kHalf) / kSpacing)),
                    int(std::lround((y + kHalf) / kSpacing)));
    });
  }
  // Of its two triangles a cell's diagonal goes from the lowest x and y to the highest.
  double height(double x, double y) const {
    const double u = (x + kHalf) / kSpacing, v = (y + kHalf) / kSpacing;
    const int i = int(u), j = int(v);
    const double a = u - i, b = v - j, z = corner(i, j), across = corner(i + 1, j + 1);
    if (a > b) return z + a * (corner(i + 1, j) - z) + b * (across - corner(i + 1, j));
    return z + b * (corner(i, j + 1) - z) + a * (across - corner(i, j + 1));
  }
};

// How many of 40 pieces end below the surface under the middle of them.
int count_below(std::uint64_t seed) {
  const Spikes spikes(seed);
  std::vector<PieceType> types = rubble_types();
  types.push_back(spikes.type());
  World world(types);
  std::vector<NewPiece> pieces{at(8, {}, {}, true)};
  RandomStream random(seed, "falling");
  for (int i = 0; i < 40; ++i) {
    const Vec3 axis = random.direction();
    const double turn = random.uniform(0, 3);
    NewPiece piece = at(i % 8, {-2.1 + 0.7 * (i % 7), -1.75 + 0.7 * (i / 7), 2.8 + 0.5 * (i % 3)},
                        turned(axis, turn));
    if (i % 8 < 2) piece.placement.scale = 0.3;
    piece.linear_velocity = {0, 0, -3};
    pieces.push_back(piece);
  }
  world.add(pieces);
  run(world, 4);
  int below = 0;
  for (int i = 1; i < world.size(); ++i) {
    const Vec3 p = world.piece(i).world_from_body.translation;
    if (std::max(std::abs(p.x), std::abs(p.y)) > Spikes::kHalf - 0.01) continue;
    if (p.z < spikes.height(p.x, p.y) - 0.005) ++below;
  }
  return below;
}

TEST(ClosedFormTerrain, NothingEndsBelowSpikes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) EXPECT_EQ(count_below(seed), 0) << seed;
}

TEST(NightlyClosedFormTerrain, NothingEndsBelowSpikesOfManySeeds) {
  for (std::uint64_t seed = 11; seed <= 60; ++seed) EXPECT_EQ(count_below(seed), 0) << seed;
}

}  // namespace closed_forms_terrain_test
}  // namespace rubble
