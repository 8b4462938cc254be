// Fines on a small pile between two walls: what each rests on, what it must not reach into, how many there are of
// each size, and catenaries against their formula.
#include "kernel/fines/strew_fines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "kernel/base/random.h"
#include "kernel/fines/fine_sites.h"
#include "kernel/fines/strands.h"
#include "kernel/geometry/fine_shapes.h"
#include "kernel/queries/queries.h"
#include "scenes.h"

namespace rubble {
namespace fines_test {

constexpr double kWallX = 1.5, kWallY = 1.2;  // faces of two walls of a corner; unit: m

// A corner of two walls, a table of stone over part of the floor, and blocks that lie about.
struct Corner {
  PileState pile;
  std::vector<TriangleMesh> meshes;

  Corner() {
    add({0.2, 4, 1.5}, {kWallX + 0.1, 0, 0.75});
    add({4, 0.2, 1.5}, {0, kWallY + 0.1, 0.75});
    add({1.2, 1.2, 0.1}, {-1, 0, 0.6});
    RandomStream random(1, "blocks");
    for (int i = 0; i < 8; ++i)
      add({0.3, 0.2, 0.15}, {random.uniform(-1.2, 1.2), random.uniform(-1, 0.9), 0.075}, random.uniform(0, 3));
  }

  void add(const Vec3& size, const Vec3& at, double yaw = 0) {
    meshes.push_back(make_collision_meshes({testing::box_type("box", size.x, size.y, size.z)})[0]);
    PieceState piece;
    piece.type = int(meshes.size()) - 1;
    piece.world_from_body = {testing::turned({0, 0, 1}, yaw), at};
    piece.status = PieceStatus::resting;
    pile.pieces.push_back(piece);
  }

  std::vector<const TriangleMesh*> pointers() const {
    std::vector<const TriangleMesh*> result;
    for (const TriangleMesh& mesh : meshes) result.push_back(&mesh);
    return result;
  }

  Fines strew(const FinesSpec& spec, std::uint64_t seed = 1, int threads = 2) const {
    return strew_fines(pile, pointers(), spec, {seed, threads});
  }
};

FinesSpec loose(int amount) {
  FinesSpec spec;
  spec.amount = amount;
  spec.drifts = spec.cables = spec.pipes = 0;
  spec.paper = spec.cloth = 0;
  return spec;
}

std::vector<Vec3> corners_of(const FinePiece& piece, const PileState& pile) {
  std::vector<Vec3> corners;
  const Pose world = world_from_host(pile, piece.host) * Pose{Quat(piece.rotation), Vec3(piece.position)};
  for (const Vec3f& p : fine_shape(piece.shape).points)
    corners.push_back(world * Vec3(Vec3f(p.x * piece.half.x, p.y * piece.half.y, p.z * piece.half.z)));
  return corners;
}

double length_of(const FinePiece& piece) { return 2 * double(piece.half.x); }

// The least distance of its corners from the pile, and how deep the deepest is in something.
struct Contact {
  double gap = 1e9, depth = 0;  // unit: m
};

Contact find_contact(const std::vector<Vec3>& corners, const PileQueries& bare, const Vec3& lifted = {}) {
  Contact contact;
  for (const Vec3& corner : corners) {
    const Vec3 p = corner + lifted;
    const double gap = bare.clearance(p, 1);
    contact.gap = std::min(contact.gap, gap);
    if (gap == 0) contact.depth = std::max(contact.depth, bare.find_closest(p, 10)->distance);
  }
  return contact;
}

TEST(Fines, AreNoneByDefault) {
  const Corner corner;
  EXPECT_TRUE(corner.strew(FinesSpec{}).empty());
  EXPECT_TRUE(Fines{}.heaps().empty());
}

// One list for pictures, queries, exports and recordings; who forgets to make it is told.
TEST(Fines, HaveTheirHeapsMadeOnce) {
  const Fines fines = Corner().strew(loose(50)), copy = fines;
  ASSERT_FALSE(fines.heaps().empty());
  EXPECT_EQ(&copy.heaps(), &fines.heaps()) << "a copy shares them";
  Fines without = fines;
  without.gathered = nullptr;
  EXPECT_THROW(without.heaps(), std::logic_error);
  heap_fines(without);
  EXPECT_EQ(without.heaps().size(), fines.heaps().size());
}

// Where there is no room for all, too, the last report is near the end.
TEST(Fines, ReportTheirProgress) {
  const Corner corner;
  for (const int amount : {2000, 400000}) {
    StrewOptions options{1, 2};
    double last = 0;
    int reports = 0, strewn = 0;
    options.progress = [&](double done, int so_far) {
      EXPECT_GT(done, 0);
      EXPECT_LE(done, 1 + 1e-9);
      EXPECT_GE(so_far, strewn);
      last = done, strewn = so_far, ++reports;
    };
    const Fines fines = strew_fines(corner.pile, corner.pointers(), loose(amount), options);
    EXPECT_EQ(strewn, int(fines.pieces.size()));
    EXPECT_GT(last, 0.9) << amount;
    EXPECT_GE(reports, 3);  // a kind each
    if (amount > 2000) {
      EXPECT_LT(fines.pieces.size(), 400000u) << "a test of what has no room";
    }
  }
}

TEST(Fines, AreTheSameForAnyNumberOfThreadsAndOthersForAnotherSeed) {
  const Corner corner;
  FinesSpec spec;
  spec.amount = 1500, spec.drifts = 6, spec.cables = 2, spec.pipes = 1;
  const Fines one = corner.strew(spec, 1, 1), two = corner.strew(spec, 1, 2), other = corner.strew(spec, 2, 1);
  const auto same = [](const Fines& a, const Fines& b) {
    static_assert(sizeof(FinePiece) == 48, "no padding between its members");
    if (a.pieces.size() != b.pieces.size() || a.sheets.size() != b.sheets.size()) return false;
    for (std::size_t i = 0; i < a.sheets.size(); ++i) {
      if (a.sheets[i].mesh.triangles != b.sheets[i].mesh.triangles) return false;
      for (std::size_t v = 0; v < a.sheets[i].mesh.positions.size(); ++v)
        if (!(a.sheets[i].mesh.positions[v] == b.sheets[i].mesh.positions[v])) return false;
    }
    return std::memcmp(a.pieces.data(), b.pieces.data(), a.pieces.size() * sizeof(FinePiece)) == 0;
  };
  EXPECT_TRUE(same(one, two));
  EXPECT_FALSE(same(one, other));
}

TEST(Fines, AreAsManyAsAskedForWhereThereIsRoom) {
  const Corner corner;
  for (const int amount : {1, 300, 3000}) {
    FinesSpec spec = loose(amount);
    const Fines fines = corner.strew(spec);
    EXPECT_EQ(int(fines.pieces.size()), amount);
    EXPECT_TRUE(fines.sheets.empty());
  }
  FinesSpec shares = loose(1000);
  shares.grit = 7, shares.plaster = 2, shares.glass = 1;
  std::array<int, 3> counts{};
  for (const FinePiece& piece : corner.strew(shares).pieces) ++counts[std::size_t(piece.kind)];
  EXPECT_EQ(counts, (std::array<int, 3>{700, 200, 100}));
}

TEST(Fines, LieOnSomethingAndNotInIt) {
  const Corner corner;
  const PileQueries bare(corner.pile, corner.pointers());
  const Fines fines = corner.strew(loose(2500));
  int lifted_touch = 0;
  double deepest = 0, mean_gap = 0;
  for (const FinePiece& piece : fines.pieces) {
    const std::vector<Vec3> corners = corners_of(piece, corner.pile);
    const double size = length_of(piece);
    const Contact contact = find_contact(corners, bare);
    EXPECT_LT(contact.gap, 0.1 * size) << "hangs in the air";
    mean_gap += contact.gap / size / double(fines.pieces.size());
    deepest = std::max(deepest, contact.depth / size);
    lifted_touch += find_contact(corners, bare, {0, 0, size}).gap < 0.1 * size;
  }
  EXPECT_LT(mean_gap, 0.02);
  EXPECT_LT(deepest, 0.35) << "of its length in another piece";
  // The check can fail: lifted by their lengths they hang in the air, but for those beside a wall.
  EXPECT_LT(lifted_touch, int(fines.pieces.size() / 5));
}

TEST(Fines, DoNotLieInEachOther) {
  const Corner corner;
  const Fines fines = corner.strew(loose(2500));
  std::vector<Vec3> centres;
  for (const FinePiece& piece : fines.pieces)
    centres.push_back(world_from_host(corner.pile, piece.host) * Vec3(piece.position));
  const auto radius = [&](std::size_t i) { return double(fines.pieces[i].half.x + fines.pieces[i].half.y) / 2; };
  for (std::size_t i = 0; i < centres.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      ASSERT_GT(distance(centres[i], centres[k]), kFineCloseness * (radius(i) + radius(k)) - 1e-5);
}

TEST(Fines, HaveSizesOfAPowerLaw) {
  const Corner corner;
  FinesSpec spec = loose(6000);
  spec.plaster = spec.glass = 0, spec.size = {0.003, 0.05};
  for (const double exponent : {1.5, 2.5}) {
    spec.exponent = exponent;
    std::array<double, 2> longer{};  // than twice and four times the least
    const Fines fines = corner.strew(spec);
    for (const FinePiece& piece : fines.pieces)
      for (std::size_t k = 0; k < 2; ++k) longer[k] += length_of(piece) > 0.006 * double(k + 1);
    const double ends = std::pow(0.05 / 0.003, -exponent);
    for (std::size_t k = 0; k < 2; ++k) {
      const double share = (std::pow(2.0 * double(k + 1), -exponent) - ends) / (1 - ends);
      // Large ones find less room.
      EXPECT_NEAR(longer[k] / double(fines.pieces.size()), share, 0.15 * share + 0.01) << exponent;
    }
  }
}

TEST(Fines, GatherAtTheFootOfWalls) {
  const Corner corner;
  double at_foot = 0, open = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4})
    for (const FinePiece& piece : corner.strew(loose(2000), seed).pieces) {
      const Vec3 at = world_from_host(corner.pile, piece.host) * Vec3(piece.position);
      const double to_wall = std::min(kWallX - at.x, kWallY - at.y);
      if (piece.host != kGroundPiece || at.x < -0.2 || at.y < -0.2 || to_wall < 0) continue;
      (to_wall < 0.2 ? at_foot : open) += 1;
    }
  const double strip = 0.2 * (1.7 + 1.4 - 0.2), rest = 1.7 * 1.4 - strip;  // unit: m2
  EXPECT_GT(at_foot / strip, 1.5 * open / rest);
}

TEST(Fines, LieInVoidsToo) {
  const Corner corner;
  int below = 0;
  for (const FinePiece& piece : corner.strew(loose(3000)).pieces) {
    const Vec3 at = world_from_host(corner.pile, piece.host) * Vec3(piece.position);
    below += piece.host == kGroundPiece && std::fabs(at.x + 1) < 0.5 && std::fabs(at.y) < 0.5;
  }
  EXPECT_GT(below, 20) << "under the table";
}

TEST(Fines, AreClosedMeshesThatFaceOutwards) {
  const Corner corner;
  FinesSpec spec;
  spec.amount = 600, spec.paper = 0.05, spec.cloth = 0.01, spec.drifts = 8, spec.cables = 2, spec.pipes = 2;
  std::array<int, kFineKinds> seen{};
  const Fines fines = corner.strew(spec);
  for (const FineHeap& heap : fines.heaps()) {
    ++seen[std::size_t(heap.kind)];
    EXPECT_TRUE(is_closed(heap.mesh)) << fine_names()[std::size_t(heap.kind)];
    EXPECT_GT(calc_volume_properties(heap.mesh).volume, 0) << fine_names()[std::size_t(heap.kind)];
    ASSERT_EQ(heap.mesh.normals.size(), heap.mesh.positions.size());
    for (const Vec3f& n : heap.mesh.normals) ASSERT_NEAR(norm(n), 1, 1e-3);
  }
  for (int kind = 0; kind < kFineKinds; ++kind) EXPECT_GT(seen[std::size_t(kind)], 0) << fine_names()[std::size_t(kind)];
}

TEST(Fines, AreMetByRaysAndFillSpace) {
  Corner corner;
  FinesSpec spec = loose(50);
  spec.size = {0.04, 0.05}, spec.plaster = spec.glass = 0;
  corner.pile.fines = corner.strew(spec);
  const PileQueries queries(corner.pile, corner.pointers());
  PileState bare = corner.pile;
  bare.fines = {};
  const PileQueries without(bare, corner.pointers());
  for (const FinePiece& piece : corner.pile.fines.pieces) {
    const Vec3 at = world_from_host(corner.pile, piece.host) * Vec3(piece.position);
    EXPECT_EQ(queries.clearance(at, 1), 0) << "inside of it";
    EXPECT_GT(without.clearance(at, 1), 0);
    const auto hit = queries.cast_ray(at + Vec3(0, 0, 0.04), {0, 0, -1}, 1);
    ASSERT_TRUE(hit.has_value());
    EXPECT_GE(hit->piece, kFirstFineHeap);
    EXPECT_GT(hit->point.z, at.z);
  }
}

TEST(Strands, HangFreeBetweenTheirEnds) {
  const Corner corner;
  const PileQueries bare(corner.pile, corner.pointers());
  FinesSpec spec = loose(1);
  spec.cables = 4, spec.pipes = 3;
  std::array<int, kFineKinds> counts{};
  for (const FineSheet& sheet : corner.strew(spec).sheets) {
    ++counts[std::size_t(sheet.kind)];
    const Pose world = world_from_host(corner.pile, sheet.host);
    const Vec3 first = world * Vec3(sheet.mesh.positions.front()), last = world * Vec3(sheet.mesh.positions.back());
    for (const Vec3f& local : sheet.mesh.positions) {
      const Vec3 p = world * Vec3(local);
      const double to_end = std::min(distance(p, first), distance(p, last));
      if (to_end > 0.12) { EXPECT_GT(bare.clearance(p, 1), 0.001) << to_end; }
    }
    EXPECT_LT(bare.clearance(first, 1), 0.02) << "its ends are held";
    EXPECT_LT(bare.clearance(last, 1), 0.02);
  }
  EXPECT_EQ(counts[std::size_t(FineKind::cable)], 4);
  EXPECT_EQ(counts[std::size_t(FineKind::pipe)], 3);
}

// The curve's own equations: ends, length, and at every place a slope of sinh((x - x0) / a), which balances the
// weight of the chain beyond it.
TEST(Catenary, HasTheLengthTheEndsAndTheSlopeOfItsFormula) {
  struct Case {
    Vec3 to;
    double length;
  };
  for (const Case& c : {Case{{2, 0, 0}, 2.5}, Case{{1, 1, 0.7}, 1.7}, Case{{0.5, -0.2, -1.5}, 2.2}, Case{{3, 0, 0}, 3.0003}}) {
    const Vec3 from{0.3, -0.2, 1};
    const Catenary curve = hang(from, from + c.to, c.length);
    EXPECT_LT(distance(curve.at(0), from), 1e-9);
    EXPECT_LT(distance(curve.at(curve.span), from + c.to), 1e-6);
    constexpr int kSteps = 20000;
    double length = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = curve.span * i / kSteps, dx = curve.span / kSteps;
      const Vec3 step = curve.at(x + dx) - curve.at(x);
      length += norm(step);
      const double slope = std::sinh((x + 0.5 * dx - curve.x0) / curve.a);
      ASSERT_NEAR(step.z / dx, slope, 1e-5 * (1 + std::fabs(slope)));
    }
    EXPECT_NEAR(length, c.length, 1e-6);
  }
  const Catenary level = hang({0, 0, 0}, {2, 0, 0}, 2.5);
  EXPECT_NEAR(level.at(1).z, -level.a * (std::cosh(1 / level.a) - 1), 1e-9);
  EXPECT_THROW(hang({0, 0, 0}, {2, 0, 0}, 1.9), std::invalid_argument);
  EXPECT_THROW(hang({0, 0, 0}, {0, 0, 1}, 1.9), std::invalid_argument);
}

TEST(Catenary, HasTheHyperbolicFunctionsOfTheLibrary) {
  for (const double x : {-30.0, -2.0, -0.1, -0.03, -1e-6, 0.0, 1e-9, 0.05, 0.0999, 0.1001, 1.0, 20.0}) {
    EXPECT_NEAR(cosh_of(x), std::cosh(x), 1e-13 * std::cosh(x));
    EXPECT_NEAR(sinh_of(x), std::sinh(x), 1e-13 * std::fabs(std::sinh(x))) << x;
  }
}

}  // namespace fines_test
}  // namespace rubble
