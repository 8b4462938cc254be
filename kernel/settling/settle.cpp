#include "kernel/settling/settle.h"

#include <algorithm>
#include <optional>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/model/pile_hash.h"
#include "kernel/model/range_check.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"
#include "kernel/world/world_snapshot.h"

namespace rubble {
namespace {

// Rest is verified from this time after the last layer on, even if pieces still move; unit: s.
constexpr double kVerifyAfter = 8;
// The bottom of a layer's spawn volume is this far above the highest point of the pile; unit: m.
constexpr double kSpawnClearance = 1.0;

class Settling {
 public:
  Settling(World& world, const Pile& pile, const SettleOptions& options,
           const SettleCallback& progress, const WorldObserver& observe)
      : pile_(pile), options_(options), progress_(progress), observe_(observe), world_(world) {}

  PileState run() {
    lay_out();
    if (pile_.building.given()) collapse_.emplace(world_, pile_, options_);
    return run_layers(0, finish_placed());
  }

  PileState resume(const SettleCheckpoint& from) {
    world_.restore(*decode_snapshot(from.world));
    layers_ = from.layers;
    layers_at_limit_ = from.layers_at_limit;
    layer_steps_ = from.layer_steps;
    const bool rested = layers_ == 0 ? finish_placed() : finish_layer(std::size_t(layers_) - 1);
    return run_layers(std::size_t(layers_), rested);
  }

 private:
  PileState run_layers(std::size_t first, bool rested) {
    for (std::size_t k = first; k < pile_.layers.size() && !stopped_; ++k) {
      spawn(k);
      rested = finish_layer(k);
    }
    if (observe_ && !stopped_) observe_(world_);
    return result(rested && !stopped_);
  }

  bool finish_layer(std::size_t k) {
    const bool last = k + 1 == pile_.layers.size();
    bool rested = false;
    if (!last && options_.schedule == Schedule::planes) {
      rested = run_until(options_.layer_time_limit, [this] { return world_.diagnostics().all_have_touched(); });
    } else {
      rested = last ? verify_rest() : run_to_rest(options_.layer_time_limit);
    }
    if (!rested && !stopped_) ++layers_at_limit_;
    return rested;
  }

  // What stands or lies there before the first layer; comes to rest first if it can move.
  void lay_out() {
    std::vector<NewPiece> pieces;
    for (const Placement& placement : pile_.placed) {
      NewPiece piece;
      piece.placement = placement;
      piece.layer = -1;
      pieces.push_back(piece);
    }
    world_.add(pieces);
  }

  bool finish_placed() {
    bool movable = pile_.building.given();
    for (int i = 0; i < world_.size() && !movable; ++i) movable = world_.mass(i) > 0;  // links of a fixed root, too
    if (!movable) return true;
    if (pile_.layers.empty()) return verify_rest();
    return run_to_rest(pile_.building.given() ? options_.final_time_limit : options_.layer_time_limit);
  }

  void spawn(std::size_t k) {
    const bool touched_only = options_.schedule == Schedule::planes;
    const double bottom =
        std::max(pile_.spawn_bottom, world_.diagnostics().highest_point(touched_only) + kSpawnClearance);
    std::vector<NewPiece> pieces;
    for (const Placement& placement : pile_.layers[k].pieces) {
      NewPiece piece;
      piece.placement = placement;
      piece.placement.world_from_body.translation.z += bottom;
      piece.layer = int(k);
      pieces.push_back(piece);
    }
    world_.add(pieces);
    ++layers_;
    layer_steps_ = 0;
  }

  bool run_to_rest(double limit) {
    return run_until(limit, [this] {
      return !is_collapsing() && world_.rest().reached(options_.rest_speed, options_.rest_angular_speed);
    });
  }

  // What fell asleep while the pile grew may have been about to slide: the end must hold awake.
  bool verify_rest() {
    const bool rests = run_until(options_.final_time_limit, [this] {
      const double speed = options_.rest_speed, angular_speed = options_.rest_angular_speed;
      if (world_.rest().verifying()) {
        return world_.rest().verified(speed, angular_speed) &&
               world_.diagnostics().deepest_overlap().depth <= options_.rest_overlap;
      }
      if (is_collapsing()) return false;
      const bool waited = double(layer_steps_) * options_.step > kVerifyAfter;
      if (waited || world_.rest().reached(speed, angular_speed)) {
        world_.rest().begin_verification(options_.final_time_limit - double(layer_steps_) * options_.step);
      }
      return false;
    });
    overlap_ = world_.diagnostics().deepest_overlap();
    if (rests) world_.rest().put_all_to_sleep();
    return rests;
  }

  // A checkpoint is made between a step and the question whether it was the last: resuming starts
  // with the question.
  template <typename Done>
  bool run_until(double limit, Done&& done) {
    const double shaking = collapse_ && layers_ == 0 ? pile_.building.cause.shaking_time() : 0;
    const std::int64_t most = std::int64_t((limit + shaking) / options_.step + 0.5);
    if (layer_steps_ > 0 && done()) return true;
    while (layer_steps_ < most) {
      if (observe_) observe_(world_);
      if (collapse_) collapse_->before_step();
      world_.step();
      if (collapse_) collapse_->after_step();
      ++layer_steps_;
      if (progress_ && !report()) {
        stopped_ = true;
        return false;
      }
      if (done()) return true;
    }
    return false;
  }

  bool report() const {
    SettleProgress p;
    p.layer = layers_;
    p.layers = int(pile_.layers.size());
    p.layer_time = double(layer_steps_) * options_.step;
    p.simulated = world_.time();
    p.pieces = world_.size();
    p.awake = world_.awake_count();
    p.verifying = world_.rest().verifying();
    if (!collapse_) p.make_checkpoint = [this] { return make_checkpoint(); };
    if (collapse_) p.collapse = collapse_->report();
    return progress_(p);
  }

  bool is_collapsing() const { return collapse_ && collapse_->goes_on(); }

  SettleCheckpoint make_checkpoint() const {
    SettleCheckpoint checkpoint;
    checkpoint.work = hash_work(pile_, options_);
    checkpoint.layers = layers_;
    checkpoint.layers_at_limit = layers_at_limit_;
    checkpoint.layer_steps = layer_steps_;
    checkpoint.world = encode_snapshot(*world_.snapshot());
    return checkpoint;
  }

  PileState result(bool settled) const {
    PileState state;
    for (const PieceType& type : pile_.types) state.types.push_back(type.name);
    for (int i = 0; i < world_.size(); ++i) {
      PieceState piece = world_.piece(i);
      const double v2 = dot(piece.linear_velocity, piece.linear_velocity);
      const double w2 = dot(piece.angular_velocity, piece.angular_velocity);
      if (piece.status == PieceStatus::moving && world_.is_touching(i) && world_.rest().within_tolerance(i) &&
          v2 < options_.rest_speed * options_.rest_speed &&
          w2 < options_.rest_angular_speed * options_.rest_angular_speed) {
        piece.status = PieceStatus::resting;
      }
      state.pieces.push_back(piece);
    }
    state.joints = world_.joints();
    if (pile_.building.given()) state.building = collapse_ ? collapse_->state(world_) : find_building_state(world_, pile_);
    state.steps = world_.steps();
    state.simulated = world_.time();
    state.settled = settled;
    state.deepest_overlap = overlap_;
    state.layers_at_limit = layers_at_limit_;
    state.lost = world_.lost_count();
    return state;
  }

  const Pile& pile_;
  const SettleOptions& options_;
  const SettleCallback& progress_;
  const WorldObserver& observe_;
  World& world_;
  std::optional<BuildingCollapse> collapse_;
  int layers_ = 0, layers_at_limit_ = 0;
  std::int64_t layer_steps_ = 0;  // since the last spawn
  bool stopped_ = false;
  DeepestOverlap overlap_;  // at the end
};

void check_checkpoint(const SettleCheckpoint& checkpoint, const Pile& pile,
                      const SettleOptions& options) {
  Diagnostic d;
  if (checkpoint.work != hash_work(pile, options)) {
    d.message = "the checkpoint is of another pile or other settling options";
    d.hint = "use the script and the seed that it was made with, or settle from the start";
  } else if (checkpoint.layers < 0 || checkpoint.layers > std::int32_t(pile.layers.size()) ||
             checkpoint.layer_steps < 1) {
    d.message = "the checkpoint is at no moment of the schedule";
  } else {
    return;
  }
  throw InputError(d);
}

}  // namespace

void SettleOptions::validate() const {
  RangeCheck check("");
  check.expect(gravity >= 0 && gravity <= 100, "gravity", "0 to 100 m/s2", gravity);
  check.expect(step >= 1e-3 && step <= 1.0 / 30 + 1e-12, "step", "1/1000 to 1/30 s", step);
  check.expect(rest_speed > 0, "rest_speed", "more than 0 m/s", rest_speed);
  check.expect(rest_angular_speed > 0, "rest_angular_speed", "more than 0 rad/s", rest_angular_speed);
  check.expect(rest_overlap > 0, "rest_overlap", "more than 0 m", rest_overlap);
  check.expect(layer_time_limit > 0, "layer_time_limit", "more than 0 s", layer_time_limit);
  check.expect(final_time_limit > 0, "final_time_limit", "more than 0 s", final_time_limit);
  check.expect(lost_below <= 0, "lost_below", "0 m or less", lost_below);
  check.expect(lost_beyond > 0, "lost_beyond", "more than 0 m", lost_beyond);
  check.expect(threads >= 0 && threads <= 1024, "threads", "0 to 1024", threads);
  check.finish();
}

PileState settle_pile(const Pile& pile, const SettleOptions& options,
                      const SettleCallback& progress, const WorldObserver& observe) {
  options.validate();
  World world(pile.types, calc_world_options(options), pile.assemblies);
  return settle_pile(world, pile, options, progress, observe);
}

PileState settle_pile(World& world, const Pile& pile, const SettleOptions& options,
                      const SettleCallback& progress, const WorldObserver& observe) {
  options.validate();
  return Settling(world, pile, options, progress, observe).run();
}

PileState resume_settling(const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options, const SettleCallback& progress,
                          const WorldObserver& observe) {
  options.validate();
  World world(pile.types, calc_world_options(options), pile.assemblies);
  return resume_settling(world, checkpoint, pile, options, progress, observe);
}

PileState resume_settling(World& world, const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options, const SettleCallback& progress,
                          const WorldObserver& observe) {
  options.validate();
  check_checkpoint(checkpoint, pile, options);
  return Settling(world, pile, options, progress, observe).resume(checkpoint);
}

SettleCheckpoint make_rest_checkpoint(const World& world, const Pile& pile, const SettleOptions& options) {
  SettleCheckpoint checkpoint;
  checkpoint.work = hash_work(pile, options);
  checkpoint.layers = std::int32_t(pile.layers.size());
  checkpoint.layer_steps = 1;
  checkpoint.world = encode_snapshot(*world.snapshot());
  return checkpoint;
}

WorldOptions calc_world_options(const SettleOptions& options) {
  WorldOptions w;
  w.gravity = options.gravity;
  w.step = options.step;
  w.lost_below = options.lost_below;
  w.lost_beyond = options.lost_beyond;
  w.threads = options.threads;
  return w;
}

std::uint64_t hash_work(const Pile& pile, const SettleOptions& options) {
  StateHash hash;
  hash.add(hash_pile(pile));
  hash.add(std::int32_t(options.schedule));
  for (double value : {options.gravity, options.step, options.rest_speed,
                       options.rest_angular_speed, options.rest_overlap,
                       options.layer_time_limit,
                       options.final_time_limit, options.lost_below, options.lost_beyond}) {
    hash.add(value);
  }
  return hash.digest();
}

}  // namespace rubble
