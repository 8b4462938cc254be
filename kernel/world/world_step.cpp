// The order of a step. Its phases are in phases/; who sleeps is decided in phases/sleep.cpp.
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr int kMostSplits = 4;  // times in a step that contacts are solved anew as something broke; unit: 1

}  // namespace

// A contact counts as touching when it carries an impulse.
void World::Impl::note_touching() {
  touched.assign(data.bodies.size(), 0);
  each_solved_fact(data, step_pairs, [this](const SolvedContact& contact, const auto&) {
    if (!contact.pressed) return;
    touched[contact.body_a] = 1;
    if (contact.body_b != kGround) touched[contact.body_b] = 1;
  });
  pool.run(int(touched.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (touched[i] != 0) data.bodies[i].touching = data.bodies[i].has_touched = true;
    }
  });
  pool.run(int(step_pairs.awake.size()), 256, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = step_pairs.awake[k];
      if (touched[i] == 0) data.bodies[i].touching = false;
    }
  });
  trees.note_touching(step_pairs);
}

void World::Impl::lose(int index) {
  Body& body = data.bodies[index];
  if (body.tree >= 0) {  // with all of its tree, except for an immovable root
    for (const std::int32_t link : trees.dissolve(body.tree)) {
      if (data.bodies[link].movable()) lose(link);
    }
    return;
  }
  body.lost = true;
  body.awake = false;
  body.touching = false;
  ++data.lost;
  if (body.free_index >= 0) blocks.set_velocity(body.free_index, {}, {});
  pairs.remove_if([&](const Pair& pair) { return pair.body_a == index || pair.body_b == index; });
  if (body.group >= 0) data.lost += int(data.groups[body.group].members.size()) - 1;
  bodies.each_collider(body, [&](int i) { data.broad.remove(i); });
}

void World::Impl::remove_lost() {
  for (std::int32_t i : step_pairs.awake) {
    const Body& body = data.bodies[i];
    if (!body.awake) continue;
    // Not the origin of its type's frame, which may lie anywhere: files come from whole scenes.
    const Vec3& p = body.world_from_com.translation;
    // Written so that a pose that is not a number is lost too.
    const bool inside = p.z >= settings.options.lost_below &&
                        p.x * p.x + p.y * p.y <= settings.options.lost_beyond * settings.options.lost_beyond;
    if (!inside) lose(i);
  }
  ties.drop_lost();
}

void World::Impl::begin_stage(StepStage stage) {
  if (on_stage) on_stage(stage);
}

void World::Impl::find_contacts() {
  begin_stage(StepStage::pairs);
  waking.wake_marked();
  pair_selection.run(step_pairs);
  begin_stage(StepStage::points);
  contact_search.run(step_pairs);
  sleep.wake_hit(step_pairs);
}

void World::Impl::solve() {
  begin_stage(StepStage::impulses);
  solution.run(step_pairs, trees, ties, limits, motions);
}

void World::step() {
  Impl& w = *impl_;
  w.find_contacts();
  w.solve();
  // What broke under these impulses could not give them: who met it meets the parts instead.
  for (int round = 0; round < kMostSplits && w.on_solved && w.on_solved(); ++round) {
    w.find_contacts();
    w.solve();
  }
  w.begin_stage(StepStage::rest);
  w.step_pairs.note_solved(w.data.contacts, w.pool);
  w.note_touching();
  w.limits.clamp_ejections(w.step_pairs, w.motions);
  w.limits.find_rolling(w.step_pairs, w.motions);
  w.limits.find_strikes(w.step_pairs, w.motions);
  w.begin_stage(StepStage::motion);
  w.advance.run(w.step_pairs, w.motions, w.solution, w.limits);
  w.trees.advance();
  w.ties.stretch(w.step_pairs);
  w.begin_stage(StepStage::rest);
  w.trees.break_joints(w.pairs);
  w.sleep.run(w.step_pairs);
  w.remove_lost();
  w.tubes.grow();
  ++w.data.steps;
  if (w.data.verification_steps >= 0) ++w.data.verification_steps;
  w.begin_stage(StepStage::none);
}

}  // namespace rubble
