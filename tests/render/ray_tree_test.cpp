// Rays against each triangle in turn: Embree's trees may hide no hit, and change no bit of one.
#include "render/geometry/ray_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace ray_tree_test {

using Triangles = std::vector<std::array<Vec3f, 3>>;

Vec3f random_point(RandomStream& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return Vec3f(Vec3(x, y, random.uniform(-size, size)));
}

TriangleCorners corners_of(const Triangles& triangles) {
  return [&triangles](std::uint32_t t) { return triangles[t]; };
}

// Slivers, and boxes along the axes with faces in common: where rounding decides.
Triangles make_soup(std::uint64_t seed) {
  RandomStream random(seed, "soup");
  Triangles out;
  for (int i = 0; i < 300; ++i) {
    const Vec3f at = random_point(random, 3);
    out.push_back({at, at + random_point(random, 0.7), at + random_point(random, i % 3 ? 0.7 : 0.002)});
  }
  for (int i = 0; i < 60; ++i) {
    const TriangleMesh box = make_box({1, 1, 0.5});
    const Vec3f at = Vec3f(float(i % 5) - 2, float(i / 5 % 4) - 2, 0.5f * float(i / 20));
    for (const auto& t : box.triangles)
      out.push_back({box.positions[t[0]] + at, box.positions[t[1]] + at, box.positions[t[2]] + at});
  }
  return out;
}

// At random; within the planes of faces, along their edges, and past corners.
constexpr double kReach = 7;

RayTree::Line make_line(RandomStream& random, const Triangles& soup, int i) {
  RayTree::Line line;
  line.from = random_point(random, i % 11 == 0 ? 60 : 4), line.direction = random_point(random, 1), line.farthest = 200;
  const auto& at = soup[random.below(soup.size())];
  if (i % 2 == 0) line.direction = at[std::size_t(i) % 3] - line.from;
  if (i % 5 == 0) line.direction.z = 0, line.from.z = at[0].z;
  if (i % 7 == 0) line.direction = {i % 3 == 0 ? 1.0f : 0.0f, i % 3 == 1 ? -1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f};
  if (i % 13 == 0) line.nearest = 1.5f, line.farthest = 3;
  return line;
}

BlockHit meet_one_by_one(const std::vector<TriangleBlock>& blocks, const BlockFunctions& functions, const RayTree::Line& line) {
  BlockHit hit;
  hit.distance = line.farthest;
  const BlockRay ray(line.from, line.direction, line.nearest, float(2 * kReach));
  for (const TriangleBlock& block : blocks) functions.meet(block, ray, hit);
  return hit;
}

std::uint64_t hash_of(const BlockHit& hit) {
  StateHash hash;
  for (const float x : {hit.distance, hit.u, hit.v, hit.normal.x, hit.normal.y, hit.normal.z}) hash.add(double(x));
  hash.add(double(hit.triangle)), hash.add(double(hit.back));
  return hash.digest();
}

TEST(RayTree, FindsTheHitOfAllTrianglesInTurn) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Triangles soup = make_soup(seed);
    RayTree tree(kReach);
    std::vector<TriangleBlock> blocks;
    append_blocks(order_blocks(std::uint32_t(soup.size()), corners_of(soup)), corners_of(soup), 0, blocks);
    tree.parts().emplace_back().mesh = tree.add_mesh(blocks);
    tree.commit();
    std::reverse(blocks.begin(), blocks.end());
    RandomStream random(seed, "rays");
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
      RayTree::Line line = make_line(random, soup, i);
      const float away = std::sqrt(dot(line.from, line.from));
      if (away > 2 * kReach) line.from = line.from * (13.9f / away);  // those from farther begin anew, nearer
      const BlockHit expected = meet_one_by_one(blocks, block_functions().front(), line);
      const RayTree::Hit found = tree.meet(line);
      ASSERT_EQ(found.triangle, expected.triangle) << "seed " << seed << ", ray " << i << ", at " << found.distance;
      if (found.triangle == RayTree::kNone) continue;
      ASSERT_EQ(hash_of(found), hash_of(expected)) << "seed " << seed << ", ray " << i;
      ASSERT_TRUE(tree.hides(line)) << "seed " << seed << ", ray " << i;
      line.farthest = std::nextafter(expected.distance, -1.0f);
      ASSERT_FALSE(tree.hides(line)) << "seed " << seed << ", ray " << i;
      ++met;
    }
    EXPECT_GT(met, 4000);
    EXPECT_LT(met, 19000);
  }
}

TEST(RayTree, HasTheSameBitsInPackets) {
  const Triangles soup = make_soup(9);
  RayTree tree(kReach);
  std::vector<TriangleBlock> blocks;
  append_blocks(order_blocks(std::uint32_t(soup.size()), corners_of(soup)), corners_of(soup), 0, blocks);
  tree.parts().emplace_back().mesh = tree.add_mesh(blocks);
  tree.commit();
  RandomStream random(9, "rays");
  for (std::size_t i = 0; i < 4000; ++i) {
    RayTree::Line lines[RayTree::kPacket];
    RayTree::Hit hits[RayTree::kPacket];
    std::uint8_t hidden[RayTree::kPacket];
    const std::size_t count = i % RayTree::kPacket + 1;
    for (std::size_t k = 0; k < count; ++k) lines[k] = make_line(random, soup, int(i + 17 * k));
    tree.meet_packet(lines, count, hits);
    tree.hide_packet(lines, count, hidden);
    for (std::size_t k = 0; k < count; ++k) {
      const RayTree::Hit alone = tree.meet(lines[k]);
      ASSERT_EQ(hash_of(hits[k]), hash_of(alone)) << "packet " << i << ", ray " << k;
      ASSERT_EQ(hits[k].part, alone.part);
      ASSERT_EQ(bool(hidden[k]), tree.hides(lines[k])) << "packet " << i << ", ray " << k;
    }
  }
}

TEST(RayTree, HasTheSameBitsWithEachInstructionSet) {
  const Triangles soup = make_soup(4);
  std::vector<TriangleBlock> blocks;
  append_blocks(order_blocks(std::uint32_t(soup.size()), corners_of(soup)), corners_of(soup), 0, blocks);
  const BlockFunctions& plain = block_functions().back();
  EXPECT_STREQ(plain.name, "plain");
  for (const BlockFunctions& functions : block_functions()) {
    RandomStream random(4, "rays");
    for (int i = 0; i < 5000; ++i) {
      const RayTree::Line line = make_line(random, soup, i);
      ASSERT_EQ(hash_of(meet_one_by_one(blocks, functions, line)), hash_of(meet_one_by_one(blocks, plain, line)))
          << functions.name << ", ray " << i;
    }
  }
}

// What moves, turns and is of another size: against its triangles where they are at the time of the ray.
TEST(RayTree, MeetsWhatMovesWhereItIs) {
  Triangles box;
  const TriangleMesh mesh = make_box({0.6, 0.3, 0.2});
  for (const auto& t : mesh.triangles) box.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  RayTree tree(kReach);
  const BlockOrder order = order_blocks(std::uint32_t(box.size()), corners_of(box));
  const std::uint32_t number = tree.add_mesh(order, corners_of(box), 0.5);
  RandomStream random(5, "movers");
  for (std::uint32_t i = 0; i < 40; ++i) {
    RayTree::Part& part = tree.parts().emplace_back();
    part.mesh = i % 7 == 3 ? RayTree::kNone : number;
    part.first_id = i * std::uint32_t(box.size());
    part.scale = random.uniform(0.5, 2);
    const double turn = random.uniform(-1.5, 1.5);
    part.first = {portable::quat_from_rpy(turn, 0.3, 2 * turn), Vec3(random_point(random, 2))};
    part.last = i % 3 == 0 ? part.first : Pose{portable::quat_from_rpy(0.2, turn, 1), Vec3(random_point(random, 2))};
  }
  tree.commit();
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    RayTree::Line line{random_point(random, 4), {}, 0, 100, float(random.uniform())};
    line.direction = random_point(random, 1) - line.from;
    double nearest = 1e9;
    for (const RayTree::Part& part : tree.parts()) {
      if (part.mesh == RayTree::kNone) continue;
      const Pose now{portable::slerp(part.first.rotation, part.last.rotation, double(line.time)),
                     part.first.translation + (part.last.translation - part.first.translation) * double(line.time)};
      Triangles placed;
      for (const auto& t : box) {
        placed.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) placed.back()[c] = Vec3f(now * (Vec3(t[c]) * part.scale));
      }
      std::vector<TriangleBlock> blocks;
      append_blocks(order, corners_of(placed), 0, blocks);
      const BlockHit hit = meet_one_by_one(blocks, block_functions().front(), line);
      if (hit.triangle != RayTree::kNone) nearest = std::min(nearest, double(hit.distance));
    }
    const RayTree::Hit found = tree.meet(line);
    if (found.triangle == RayTree::kNone && nearest > 1e8) continue;
    ASSERT_NEAR(found.distance, nearest, 1e-4) << "ray " << i;
    ASSERT_EQ(found.triangle / box.size(), found.part);
    ++met;
  }
  EXPECT_GT(met, 1000);
}

// A ray that begins within a surface meets it at no distance: whatever is beside it in a corner is not open.
TEST(RayTree, MeetsWhatItBeginsIn) {
  const Triangles wall(1, {Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{0, 2, 0}});
  RayTree tree(2);
  tree.parts().emplace_back().mesh = tree.add_mesh(order_blocks(1, corners_of(wall)), corners_of(wall));
  tree.commit();
  for (const float up : {1.0f, -1.0f}) {
    EXPECT_EQ(tree.meet({{0.5f, 0.5f, 0}, {0.1f, 0.2f, up}, 0, 5, 0}).distance, 0);
    EXPECT_TRUE(tree.hides({{0.5f, 0.5f, 0}, {0.1f, 0.2f, up}, 0, 5, 0}));
    EXPECT_EQ(tree.meet({{0.5f, 0.5f, 0}, {0.1f, 0.2f, up}, 1e-6f, 5, 0}).triangle, RayTree::kNone);
  }
}

TEST(RayTree, TakesTheSmallerNumberOfEqualHits) {
  const Triangles twice(2, {Vec3f{0, 0, 1}, Vec3f{1, 0, 1}, Vec3f{0, 1, 1}});
  RayTree tree(1);
  const BlockOrder order = order_blocks(2, corners_of(twice));
  for (const std::uint32_t first : {7u, 3u, 5u}) {
    RayTree::Part& part = tree.parts().emplace_back();
    part.mesh = tree.add_mesh(order, corners_of(twice)), part.first_id = first;
  }
  tree.commit();
  const RayTree::Hit hit = tree.meet({{0.2f, 0.2f, 0}, {0, 0, 1}, 0, 9, 0});
  EXPECT_EQ(hit.triangle, 3u);
  EXPECT_EQ(hit.part, 1u);
}

// From inside a closed body no ray finds a way out, least of all through edges and corners.
TEST(RayTree, LetsNoRayThroughAnEdge) {
  const TriangleMesh sphere = make_sphere(24);
  Triangles triangles;
  for (const auto& t : sphere.triangles)
    triangles.push_back({sphere.positions[t[0]], sphere.positions[t[1]], sphere.positions[t[2]]});
  RayTree tree(1);
  const BlockOrder order = order_blocks(std::uint32_t(triangles.size()), corners_of(triangles));
  tree.parts().emplace_back().mesh = tree.add_mesh(order, corners_of(triangles));
  tree.commit();
  RandomStream random(6, "rays");
  for (int i = 0; i < 20000; ++i) {
    const auto& t = triangles[random.below(triangles.size())];
    const auto along = float(random.uniform());
    const Vec3f from = random_point(random, 0.3), to = t[0] * along + t[1] * (1 - along);
    const RayTree::Hit hit = tree.meet({from, to - from, 0, 10, 0});
    ASSERT_NE(hit.triangle, RayTree::kNone) << "ray " << i;
    ASSERT_NEAR(hit.distance, 1, 1e-3);
    ASSERT_TRUE(hit.back);
  }
}

// A ray from a kilometre away meets what it would meet from near.
TEST(RayTree, MeetsWhatIsFarAway) {
  const Triangles soup = make_soup(8);
  RayTree tree(kReach);
  std::vector<TriangleBlock> blocks;
  append_blocks(order_blocks(std::uint32_t(soup.size()), corners_of(soup)), corners_of(soup), 0, blocks);
  tree.parts().emplace_back().mesh = tree.add_mesh(blocks);
  tree.commit();
  RandomStream random(8, "rays");
  int met = 0, same = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f to = random_point(random, 2);
    Vec3f d = random_point(random, 1);
    d = d * (1 / std::sqrt(dot(d, d)));
    const RayTree::Hit near = tree.meet({to - d * 10.0f, d, 0, 30, 0}), far = tree.meet({to - d * 1000.0f, d, 0, 1030, 0});
    met += near.triangle != RayTree::kNone;
    same += near.triangle != RayTree::kNone && std::fabs(far.distance - 990 - near.distance) < 2e-3f;
    ASSERT_EQ(tree.hides({to - d * 1000.0f, d, 0, 1030, 0}), far.triangle != RayTree::kNone);
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(same, met * 97 / 100);
}

}  // namespace ray_tree_test
}  // namespace rubble::testing
