// Settled piles of known balance, from their poses to the judgement.
#include "bench/equilibrium/pile_balance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace pile_balance_test {

constexpr double kGravity = 9.81;
constexpr double kSolved = 1e-5;

PieceType make_box(const Vec3& half, double friction = 0.6) {
  PieceType type;
  type.name = "box";
  type.friction = friction;
  ConvexPart part;
  for (double x : {-half.x, half.x})
    for (double y : {-half.y, half.y})
      for (double z : {-half.z, half.z}) part.points.push_back({x, y, z});
  type.parts.push_back(part);
  return type;
}

PieceState at(int type, const Vec3& place, const Quat& turned = {},
              PieceStatus status = PieceStatus::resting) {
  PieceState piece;
  piece.type = type;
  piece.world_from_body = {turned, place};
  piece.status = status;
  return piece;
}

BalanceResult judge(const Pile& pile, const PileState& state) {
  return solve_balance(make_pile_balance(pile, state, kGravity).problem);
}

// A tower of slabs of 1 x 1 x 0.2 m, 1 mm apart as the kernel leaves them.
struct Tower {
  Pile pile;
  PileState state;
};
Tower make_tower() {
  Tower tower;
  tower.pile.types = {make_box({0.5, 0.5, 0.1})};
  for (int i = 0; i < 4; ++i) tower.state.pieces.push_back(at(0, {0, 0, 0.101 + 0.201 * i}));
  return tower;
}

TEST(PileBalance, AStraightTowerIsInBalanceAndCarriesItsWeight) {
  const Tower tower = make_tower();
  const PileBalance balance = make_pile_balance(tower.pile, tower.state, kGravity);
  ASSERT_EQ(balance.problem.bodies.size(), 4U);
  EXPECT_NEAR(balance.problem.bodies[0].weight, 0.2 * 2400 * kGravity, 1e-6);
  // Of a box: sqrt((a^2 + b^2 + c^2) / 12), by edges.
  EXPECT_NEAR(balance.problem.bodies[0].length, std::sqrt((1 + 1 + 0.04) / 12), 1e-6);
  const BalanceResult result = solve_balance(balance.problem);
  EXPECT_LT(result.mean_residual(), kSolved);
  double ground = 0;
  for (std::size_t i = 0; i < balance.problem.contacts.size(); ++i)
    if (balance.problem.contacts[i].a == kImmovable) ground += result.contact_force[i].z;
  EXPECT_NEAR(ground, 4 * 0.2 * 2400 * kGravity, 0.1);
}

TEST(PileBalance, FindsThePieceThatWasTurnedAfterRest) {
  Tower tower = make_tower();
  tower.state.pieces[3].world_from_body.rotation = portable::quat_from_rpy(0.2, 0, 0);
  const BalanceResult result = judge(tower.pile, tower.state);
  EXPECT_GT(result.residual[3], 0.1);
  EXPECT_LT(result.residual[0], 0.01);
}

TEST(PileBalance, FindsThePieceThatWasLiftedAfterRest) {
  Tower tower = make_tower();
  tower.state.pieces[3].world_from_body.translation.z += 0.01;
  const BalanceResult result = judge(tower.pile, tower.state);
  EXPECT_DOUBLE_EQ(result.residual[3], 1);
  EXPECT_EQ(result.count_above(0.01), 1);
}

TEST(PileBalance, FindsTheTowerThatLeansTooFar) {
  Tower tower = make_tower();
  const auto shift = [&tower](double step) {
    for (int i = 0; i < 4; ++i) tower.state.pieces[std::size_t(i)].world_from_body.translation.x = i * step;
  };
  shift(0.245);  // the three above stand over the first's edge while 2 steps < half a slab
  EXPECT_LT(judge(tower.pile, tower.state).mean_residual(), kSolved);
  shift(0.255);
  EXPECT_GT(judge(tower.pile, tower.state).mean_residual(), 0.001);
}

TEST(PileBalance, LostAndFixedPiecesNeedNoBalance) {
  Tower tower = make_tower();
  tower.state.pieces[0].status = PieceStatus::lost;   // so that nothing carries the second
  tower.state.pieces[1].status = PieceStatus::fixed;  // but it is held
  const PileBalance balance = make_pile_balance(tower.pile, tower.state, kGravity);
  EXPECT_EQ(balance.pieces, (std::vector<int>{2, 3}));
  EXPECT_LT(solve_balance(balance.problem).mean_residual(), kSolved);
}

TEST(PileBalance, TheSlopeThatHoldsABoxIsThatOfItsFriction) {
  for (const double more : {-0.01, 0.01}) {
    Pile pile;
    pile.types = {make_box({0.3, 0.3, 0.1}, 0.5), make_box({3, 3, 0.1}, 0.5)};
    const double angle = std::atan(0.5) + more;
    const Quat turned = portable::quat_from_rpy(0, -angle, 0);
    PileState state;
    state.pieces = {at(1, {0, 0, 5}, turned, PieceStatus::fixed),
                    at(0, Vec3{0, 0, 5} + turned.rotate({0, 0, 0.201}), turned)};
    const BalanceResult result = judge(pile, state);
    if (more < 0) {
      EXPECT_LT(result.residual[0], kSolved);
    } else {
      EXPECT_GT(result.residual[0], 0.005);
    }
  }
}

// Two boxes on a hinge about Y between them, the first of them held; the second sticks out level.
struct Flap {
  Pile pile;
  PileState state;
};
Flap make_flap(JointKind kind, double stiffness, double rest) {
  Flap flap;
  flap.pile.types = {make_box({0.5, 0.2, 0.05})};
  AssemblyType assembly;
  assembly.links = {{0, {}, 1}, {0, {{}, {1.1, 0, 0}}, 1}};
  JointType joint;
  joint.kind = kind;
  const Quat z_along_y = portable::quat_from_rpy(-portable::kPi / 2, 0, 0);
  joint.assembly_from_joint = {z_along_y, {0.55, 0, 0}};
  joint.stiffness = stiffness;
  assembly.joints = {joint};
  flap.pile.assemblies = {assembly};
  Placement placement;
  placement.kind = PieceKind::assembly(0);
  placement.world_from_body.translation = {0, 0, 2};
  placement.fixed = true;
  flap.pile.placed = {placement};
  flap.state.pieces = {at(0, {0, 0, 2}, {}, PieceStatus::fixed), at(0, {1.1, 0, 2})};
  JointState state;
  state.parent = 0, state.child = 1;
  state.kind = kind;
  state.parent_from_joint = {z_along_y, {0.55, 0, 0}};
  state.child_from_joint = {z_along_y, {-0.55, 0, 0}};
  state.rest = rest;
  flap.state.joints = {state};
  return flap;
}

const double kFlapMoment = 1 * 0.4 * 0.1 * 2400 * kGravity * 0.55;  // about the hinge; unit: N m

TEST(PileBalance, AHingedPairHangsOnItsSpring) {
  const auto residual = [](const Flap& flap) { return judge(flap.pile, flap.state).residual[0]; };
  EXPECT_LT(residual(make_flap(JointKind::weld, 0, 0)), kSolved);
  EXPECT_GT(residual(make_flap(JointKind::hinge, 0, 0)), 0.5);
  // Its weight turns the free end down, a positive turn about Y; the spring's rest is above by as much
  // as makes its torque the weight's.
  const double stiffness = 8000, rest = -kFlapMoment / stiffness;
  EXPECT_LT(residual(make_flap(JointKind::hinge, stiffness, rest)), kSolved);
  EXPECT_GT(residual(make_flap(JointKind::hinge, stiffness, -rest)), 0.5);
}

TEST(PileBalance, DryFrictionHoldsAHingeUpToItsLimit) {
  Flap flap = make_flap(JointKind::hinge, 0, 0);
  flap.pile.assemblies[0].joints[0].friction = kFlapMoment * 1.001;
  EXPECT_LT(judge(flap.pile, flap.state).residual[0], kSolved);
  flap.pile.assemblies[0].joints[0].friction = kFlapMoment * 0.9;
  EXPECT_GT(judge(flap.pile, flap.state).residual[0], 0.05);
}

TEST(PileBalance, AStopCarriesWhatLeansOnIt) {
  Flap flap = make_flap(JointKind::hinge, 0, 0);
  flap.pile.assemblies[0].joints[0].upper = 0;  // it cannot turn down
  EXPECT_LT(judge(flap.pile, flap.state).residual[0], kSolved);
  flap = make_flap(JointKind::hinge, 0, 0);
  flap.pile.assemblies[0].joints[0].lower = 0;  // it cannot turn up
  EXPECT_GT(judge(flap.pile, flap.state).residual[0], 0.5);
}

TEST(PileBalance, ABallHangsOnItsSpringToo) {
  Flap flap = make_flap(JointKind::ball, 8000, 0);
  const double half_sine = kFlapMoment / 8000 / 2;  // the torque is 2 k sin(x / 2)
  const double cosine = std::sqrt(1 - half_sine * half_sine);
  flap.state.joints[0].rest_rotation = {cosine, 0, 0, -half_sine};
  EXPECT_LT(judge(flap.pile, flap.state).residual[0], kSolved);
  flap.state.joints[0].rest_rotation = {};
  EXPECT_GT(judge(flap.pile, flap.state).residual[0], 0.5);
}

TEST(PileBalance, RefusesAJointThatTheMissionHasNot) {
  Flap flap = make_flap(JointKind::hinge, 0, 0);
  flap.pile.placed.clear();
  EXPECT_THROW(judge(flap.pile, flap.state), InputError);
}

}  // namespace pile_balance_test
}  // namespace rubble
