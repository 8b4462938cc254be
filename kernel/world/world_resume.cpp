// A world that goes on from a pile that has settled: from the plain state, so that it does not matter
// which run, program or machine settled it.
#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"
#include "kernel/world/world_rest.h"

namespace rubble {
namespace {

// So long all pieces are awake, until their contacts carry what lies on them; unit: s.
constexpr double kLoadingTime = 0.5;
// Of ties in that time: none tears; unit: m.
constexpr double kEndlessStretch = 1e9;

[[noreturn]] void refuse_state(const std::string& what) {
  Diagnostic d;
  d.message = "the settled pile is not of this mission: " + what;
  d.hint = "settle it again";
  throw InputError(d);
}

bool is_of_same(const TieState& a, const TieState& b) {
  return a.piece_a == b.piece_a && a.piece_b == b.piece_b && distance(a.anchor_a, b.anchor_a) == 0 &&
         distance(a.anchor_b, b.anchor_b) == 0;
}

// What the building's part of a state refers to must be there, and be able to move as it says.
void check_building(const Pile& pile, const PileState& state) {
  const BuildingState& building = state.building;
  if (pile.building.given() && building.count == 0) {
    refuse_state("it does not say which pieces of the building hold together (written by an earlier version)");
  }
  if (building.count == 0) return;
  const int end = building.first + building.count;
  if (!pile.building.given() || end > int(state.pieces.size())) refuse_state("it has a building, the mission none");
  std::vector<std::uint8_t> seen(state.pieces.size(), 0);
  for (const std::vector<std::int32_t>& body : building.bodies) {
    std::int32_t before = -1;
    for (const std::int32_t piece : body) {
      if (piece < building.first || piece >= end || piece <= before || seen[std::size_t(piece)]++) {
        refuse_state("other pieces that hold together");
      }
      const PieceState &a = state.pieces[std::size_t(body.front())], &b = state.pieces[std::size_t(piece)];
      const Quat &p = a.world_from_body.rotation, &q = b.world_from_body.rotation;
      const bool alike = p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z;
      if (a.status != b.status || b.status == PieceStatus::lost || b.scale != 1 || !alike) {
        refuse_state("other pieces that hold together");
      }
      before = piece;
    }
  }
}

}  // namespace

// Back to where the pile lay, asleep.
void World::Impl::lay_to_rest(const PileState& state, const std::vector<TreeState>& tree_states) {
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    Body& body = data.bodies[i];
    if (!body.movable() || body.tree >= 0) continue;
    const Pose& at = state.pieces[i].world_from_body;
    const Pose to{normalized(at.rotation), at * body.com_in_type};
    body.travel += distance(body.world_from_com.translation, to.translation) + 2 * double(body.radius);
    blocks.set_pose(body.free_index, to);
    bodies.mirror(body);
    bodies.refresh(body);
  }
  for (std::size_t i = 0; i < tree_states.size(); ++i) {
    if (simbody_trees.state(int(i)).q.size() != tree_states[i].q.size()) continue;  // a joint broke
    simbody_trees.set_state(int(i), tree_states[i]);
    trees.mirror_state(int(i));
  }
  // Ties of pieces that were lost are gone; the others are in their order.
  auto from = state.building.ties.begin();
  for (Tie& tie : data.ties) {
    while (!is_of_same(*from, tie.state)) ++from;
    tie.state = *from++;
  }
  data.tie_energy = 0;
}

void World::lay(const Pile& pile, const PileState& state, bool fixed) {
  Impl& w = *impl_;
  if (size() > 0) throw RunError("a settled pile is laid into an empty world");
  std::vector<std::uint8_t> bound(state.pieces.size(), 0);
  if (!fixed) {
    check_building(pile, state);
    for (const auto& body : state.building.bodies)
      for (const std::int32_t piece : body) bound[std::size_t(piece)] = 1;
  }
  std::vector<FreeBody> free(state.pieces.size());
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState& from = state.pieces[i];
    if (from.type < 0 || from.type >= w.types.placeable) refuse_state("other types of pieces");
    NewPiece piece;
    piece.layer = from.layer;
    piece.placement = {from.type, from.scale, from.world_from_body,
                       fixed || bound[i] || from.status == PieceStatus::fixed};
    w.bodies.add(piece, &free[i]);
    w.data.bodies.back().has_touched = true;
    if (from.status != PieceStatus::lost) continue;
    w.data.bodies.back().lost = true;
    w.data.bodies.back().awake = false;
    ++w.data.lost;
  }
  if (!fixed) {
    for (const auto& body : state.building.bodies) {
      const SplitPart part{{body.begin(), body.end()},
                           state.pieces[std::size_t(body.front())].status == PieceStatus::fixed};
      w.groups.lay(part, &free[std::size_t(body.front())]);
    }
    w.trees.join_settled(pile, state);
    for (const TieState& tie : state.building.ties) w.ties.add(tie);
  }
  w.bodies.add_to_blocks(0, free);
  w.pairs.introduce(0);
  if (fixed) return;
  // What each contact, joint and tie carries: all is awake for a while, and then back in its place, asleep.
  std::vector<TreeState> tree_states;
  for (int i = 0; i < w.simbody_trees.size(); ++i) tree_states.push_back(w.simbody_trees.state(i));
  for (Tie& tie : w.data.ties) tie.state.stretch = kEndlessStretch;
  const bool sleeping = w.settings.options.sleeping;
  w.settings.options.sleeping = false;
  if (!state.building.loads.empty()) w.find_contacts(), w.put_loads(state.building);
  while (time() < kLoadingTime) step();
  w.settings.options.sleeping = sleeping;
  rest().put_all_to_sleep();
  w.lay_to_rest(state, tree_states);
  w.data.steps = 0;
}

}  // namespace rubble
