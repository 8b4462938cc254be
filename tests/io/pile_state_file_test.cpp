#include "io/state/pile_state_file.h"
#include "io/base/sealed_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "tests/io/support.h"

namespace rubble {
namespace pile_state_file_test {

using test::read_text;
using test::ScratchFolder;

PileState make_state(int pieces) {
  RandomStream random(7, "pile state test");
  PileState state;
  state.types = {"slab", "", "Brocken \xC3\xBC"};
  state.steps = 123456789012;
  state.simulated = 0.1 + 0.2;
  state.settled = true;
  state.layers_at_limit = 2;
  state.lost = 3;
  for (int i = 0; i < pieces; ++i) {
    PieceState p;
    p.type = i % 3;
    p.layer = i % 5 - 1;
    p.scale = random.uniform(0.5, 2);
    p.world_from_body = {random.rotation(), random.direction()};
    p.linear_velocity = random.direction();
    p.angular_velocity = {-0.0, std::numeric_limits<double>::denorm_min(), 1e300};
    p.status = static_cast<PieceStatus>(i % 4);
    state.pieces.push_back(p);
  }
  for (int i = 0; i + 1 < pieces; i += 3) {
    JointState joint;
    joint.parent = i;
    joint.child = i + 1;
    joint.kind = static_cast<JointKind>(i % 4);
    joint.parent_from_joint = {random.rotation(), random.direction()};
    joint.child_from_joint = {random.rotation(), random.direction()};
    joint.rest = random.uniform(-1, 1);
    joint.rest_rotation = random.rotation();
    state.joints.push_back(joint);
  }
  return state;
}

BuildingState make_building() {
  BuildingState building;
  building.first = 3, building.count = 10;
  building.bodies = {{3, 5, 12}, {4, 7}};
  building.ties = {{3, 4, {0.1, -0.0, 1e-300}, {1, 2, 3}, 0.1 + 0.2, 1e5, 0, 12}, {12, -1, {}, {4, 5, 6}, 1, 2, 3, 0}};
  return building;
}

// Without the flush to the disk that write_text_file makes: there are hundreds of files.
void write_quickly(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template <typename T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::string error_of(const std::string& path) {
  try {
    load_pile_state(path);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "no error";
}

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

TEST(PileStateFile, ReloadsBitForBit) {
  ScratchFolder folder;
  const PileState state = make_state(100);
  save_pile_state(state, folder / "pile.bin");
  const PileState loaded = load_pile_state(folder / "pile.bin");
  EXPECT_EQ(loaded.types, state.types);
  EXPECT_EQ(loaded.steps, state.steps);
  EXPECT_EQ(loaded.simulated, state.simulated);
  EXPECT_EQ(loaded.settled, state.settled);
  EXPECT_EQ(loaded.layers_at_limit, state.layers_at_limit);
  EXPECT_EQ(loaded.lost, state.lost);
  EXPECT_EQ(loaded.state_hash(), state.state_hash());
  ASSERT_EQ(loaded.pieces.size(), state.pieces.size());
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState &a = state.pieces[i], &b = loaded.pieces[i];
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.layer, b.layer);
    EXPECT_EQ(a.status, b.status);
    EXPECT_TRUE(same_bits(a.scale, b.scale));
    EXPECT_TRUE(same_bits(a.world_from_body, b.world_from_body)) << "piece " << i;
    EXPECT_TRUE(same_bits(a.linear_velocity, b.linear_velocity)) << "piece " << i;
    EXPECT_TRUE(same_bits(a.angular_velocity, b.angular_velocity)) << "piece " << i;
  }
  ASSERT_EQ(loaded.joints.size(), state.joints.size());
  for (std::size_t i = 0; i < state.joints.size(); ++i) {
    const JointState &a = state.joints[i], &b = loaded.joints[i];
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.child, b.child);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_TRUE(same_bits(a.parent_from_joint, b.parent_from_joint));
    EXPECT_TRUE(same_bits(a.child_from_joint, b.child_from_joint));
    EXPECT_TRUE(same_bits(a.rest, b.rest));
    EXPECT_TRUE(same_bits(a.rest_rotation, b.rest_rotation));
  }
}

TEST(PileStateFile, KeepsWhatHoldsTogetherOfABuilding) {
  ScratchFolder folder;
  PileState state = make_state(20);
  save_pile_state(state, folder / "without");
  state.building = make_building();
  save_pile_state(state, folder / "a");
  const PileState loaded = load_pile_state(folder / "a");
  EXPECT_EQ(loaded.building.first, 3);
  EXPECT_EQ(loaded.building.count, 10);
  EXPECT_EQ(loaded.building.bodies, state.building.bodies);
  ASSERT_EQ(loaded.building.ties.size(), 2u);
  EXPECT_TRUE(same_bits(loaded.building.ties[0], state.building.ties[0]));
  EXPECT_TRUE(same_bits(loaded.building.ties[1], state.building.ties[1]));
  save_pile_state(loaded, folder / "b");
  EXPECT_EQ(read_text(folder / "a"), read_text(folder / "b"));
  // A file without a building is that of the version before, byte for byte.
  EXPECT_EQ(read_text(folder / "without")[8], 2);
  EXPECT_EQ(read_text(folder / "a")[8], 4);
  EXPECT_EQ(load_pile_state(folder / "without").building.count, 0);
}

TEST(PileStateFile, KeepsWhatABuildingCarriesAndReadsThoseOfBefore) {
  ScratchFolder folder;
  PileState state = make_state(20);
  state.building = make_building();
  state.building.tie_forces = {12.5F, 0};
  state.building.loads = {{4, -1, {1, 2, 3}, {0, 0, 50}}, {5, 19, {-1, 0.5F, 2}, {3, -4, 12}}};
  save_pile_state(state, folder / "a");
  const BuildingState loaded = load_pile_state(folder / "a").building;
  EXPECT_EQ(loaded.tie_forces, state.building.tie_forces);
  ASSERT_EQ(loaded.loads.size(), 2u);
  EXPECT_EQ(loaded.loads[0].other, -1);
  EXPECT_EQ(loaded.loads[1].piece, 5);
  EXPECT_EQ(loaded.loads[1].other, 19);
  EXPECT_EQ(loaded.loads[1].point.y, 0.5F);
  EXPECT_EQ(loaded.loads[1].force.z, 12.0F);
  // Version 3 ends with the ties.
  SealedKind kind{"RUBPILE\n", 4, "pile state", "", "", 2};
  std::string content = load_sealed(kind, folder / "a");
  content.resize(content.size() - (2 * 4 + 4 + 2 * 32));
  kind.version = 3;
  save_sealed(kind, content, folder / "before");
  const BuildingState before = load_pile_state(folder / "before").building;
  EXPECT_EQ(before.ties.size(), 2u);
  EXPECT_TRUE(before.loads.empty());
  EXPECT_TRUE(before.tie_forces.empty());
}

TEST(PileStateFile, RefusesABuildingThatCannotBe) {
  ScratchFolder folder;
  const auto error_with = [&](const auto& change) {
    PileState state = make_state(20);
    state.building = make_building();
    change(state.building);
    save_pile_state(state, folder / "pile.bin");
    return error_of(folder / "pile.bin");
  };
  expect_in(error_with([](BuildingState&) {}), "no error");
  expect_in(error_with([](BuildingState& b) { b.count = 18; }), "pieces that the pile does not have");
  expect_in(error_with([](BuildingState& b) { b.first = -1; }), "pieces that the pile does not have");
  expect_in(error_with([](BuildingState& b) { b.bodies[0] = {3}; }), "has 1 pieces");
  expect_in(error_with([](BuildingState& b) { b.bodies[0] = {3, 13}; }), "not the building's");
  expect_in(error_with([](BuildingState& b) { b.bodies[0] = {5, 3}; }), "in no order");
  expect_in(error_with([](BuildingState& b) { b.bodies[1] = {4, 5}; }), "in two bodies");
  expect_in(error_with([](BuildingState& b) { b.ties[0].piece_a = 20; }), "a tie holds a piece");
  expect_in(error_with([](BuildingState& b) { b.ties[0].piece_b = 3; }), "a tie holds a piece");
  expect_in(error_with([](BuildingState& b) { b.ties[0].length = 0; }), "out of range");
  expect_in(error_with([](BuildingState& b) { b.ties[1].anchor_b.x = std::nan(""); }), "not finite");
  expect_in(error_with([](BuildingState& b) { b.tie_forces = {0, std::nanf("")}; }), "not finite");
  expect_in(error_with([](BuildingState& b) { b.loads = {{20, -1, {}, {}}}; }), "a load is on a piece");
  expect_in(error_with([](BuildingState& b) { b.loads = {{3, 3, {}, {}}}; }), "a load is on a piece");
  expect_in(error_with([](BuildingState& b) { b.loads = {{3, -1, {}, {0, 0, std::nanf("")}}}; }), "not finite");
}

TEST(PileStateFile, IsTheSameFileForTheSameStateAndAnotherForAnother) {
  ScratchFolder folder;
  PileState state = make_state(5);
  save_pile_state(state, folder / "a");
  save_pile_state(load_pile_state(folder / "a"), folder / "b");
  EXPECT_EQ(read_text(folder / "a"), read_text(folder / "b"));
  const std::uint64_t hash = state.state_hash();
  state.pieces[3].world_from_body.translation.z += 1e-15;
  save_pile_state(state, folder / "c");
  EXPECT_NE(read_text(folder / "a"), read_text(folder / "c"));
  EXPECT_NE(load_pile_state(folder / "c").state_hash(), hash);
}

// With its checksum right: a file that somebody made so, or a bug of ours.
TEST(PileStateFile, RefusesWhatIsNotFinite) {
  ScratchFolder folder;
  const auto error_with = [&](const auto& change) {
    PileState state = make_state(4);
    change(state);
    save_pile_state(state, folder / "odd");
    return error_of(folder / "odd");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  expect_in(error_with([&](PileState& s) { s.pieces[1].world_from_body.translation.y = nan; }),
            "odd: a piece has a number that is not finite");
  expect_in(error_with([&](PileState& s) { s.pieces[1].world_from_body.rotation.w = nan; }),
            "not finite");
  expect_in(error_with([&](PileState& s) { s.pieces[3].linear_velocity.x = infinite; }),
            "not finite");
  expect_in(error_with([&](PileState& s) { s.pieces[0].scale = nan; }), "not finite");
  expect_in(error_with([&](PileState& s) { s.pieces[0].scale = 0; }), "no sensible scale");
  expect_in(error_with([&](PileState& s) { s.pieces[0].world_from_body.rotation = {0, 0, 0, 0}; }),
            "no rotation of length 1");
  expect_in(error_with([&](PileState& s) { s.pieces[0].world_from_body.translation.z = 1e30; }),
            "too far away");
  expect_in(error_with([&](PileState& s) { s.simulated = nan; }), "the pile has a number");
  expect_in(error_with([&](PileState& s) { s.joints[0].parent_from_joint.translation.x = nan; }),
            "a joint has a number");
  EXPECT_EQ(error_with([](PileState&) {}), "no error");
}

TEST(PileStateFile, RefusesEveryTruncation) {
  ScratchFolder folder;
  save_pile_state(make_state(2), folder / "whole");
  const std::string whole = read_text(folder / "whole");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_quickly(folder / "cut", whole.substr(0, size));
    const std::string error = error_of(folder / "cut");
    ASSERT_NE(error, "no error") << "the first " << size << " bytes were accepted";
    expect_in(error, folder / "cut");
    if (size >= 8) expect_in(error, "truncated");
  }
}

TEST(PileStateFile, RefusesEveryAlteredByte) {
  ScratchFolder folder;
  save_pile_state(make_state(2), folder / "whole");
  const std::string whole = read_text(folder / "whole");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string altered = whole;
    altered[i] = static_cast<char>(altered[i] ^ 0x10);
    write_quickly(folder / "altered", altered);
    ASSERT_NE(error_of(folder / "altered"), "no error") << "byte " << i << " could be changed";
  }
  write_text_file(folder / "altered", whole);  // the negative control
  EXPECT_EQ(error_of(folder / "altered"), "no error");
}

TEST(PileStateFile, SaysWhatIsWrong) {
  ScratchFolder folder;
  save_pile_state(make_state(2), folder / "whole");
  const std::string whole = read_text(folder / "whole");
  write_text_file(folder / "foreign", "PNG and so on, long enough to be anything at all..........");
  expect_in(error_of(folder / "foreign"), "is not a pile state");
  expect_in(error_of(folder / "missing"), "cannot be opened: No such file");
  std::string altered = whole;
  altered[60] = static_cast<char>(altered[60] ^ 1);
  write_text_file(folder / "altered", altered);
  expect_in(error_of(folder / "altered"), "does not match its checksum");
  altered = whole;
  altered[8] = 9;
  write_text_file(folder / "newer", altered);
  expect_in(error_of(folder / "newer"), "format version 9");
  write_text_file(folder / "longer", whole + "x");
  expect_in(error_of(folder / "longer"), "longer than it says");
}

}  // namespace pile_state_file_test
}  // namespace rubble
