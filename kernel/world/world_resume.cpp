// A world that goes on from a pile that has settled: from the plain state, so that it does not matter
// which run, program or machine settled it.
#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// So long all pieces are awake, until their contacts carry what lies on them; unit: s.
constexpr double kLoadingTime = 0.5;

[[noreturn]] void refuse_state(const std::string& what) {
  Diagnostic d;
  d.message = "the settled pile is not of this mission: " + what;
  d.hint = "settle it again";
  throw InputError(d);
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
}

void World::lay(const Pile& pile, const PileState& state, bool fixed) {
  Impl& w = *impl_;
  if (size() > 0) throw RunError("a settled pile is laid into an empty world");
  std::vector<FreeBody> free(state.pieces.size());
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState& from = state.pieces[i];
    if (from.type < 0 || from.type >= w.types.placeable) refuse_state("other types of pieces");
    NewPiece piece;
    piece.layer = from.layer;
    piece.placement = {from.type, from.scale, from.world_from_body, fixed || from.status == PieceStatus::fixed};
    w.bodies.add(piece, &free[i]);
    w.data.bodies.back().has_touched = true;
    if (from.status != PieceStatus::lost) continue;
    w.data.bodies.back().lost = true;
    w.data.bodies.back().awake = false;
    ++w.data.lost;
  }
  if (!fixed) w.trees.join_settled(pile, state);
  w.bodies.add_to_blocks(0, free);
  w.pairs.introduce(0);
  if (fixed) return;
  std::vector<TreeState> tree_states;
  for (int i = 0; i < w.simbody_trees.size(); ++i) tree_states.push_back(w.simbody_trees.state(i));
  const bool sleeping = w.settings.options.sleeping;
  w.settings.options.sleeping = false;
  while (time() < kLoadingTime) step();
  w.settings.options.sleeping = sleeping;
  put_all_to_sleep();
  w.lay_to_rest(state, tree_states);
  w.data.steps = 0;
}

}  // namespace rubble
