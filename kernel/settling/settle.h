// Settling: drops a Pile and verifies its rest.
#pragma once

#include <functional>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/settling/collapse_report.h"
#include "kernel/settling/settle_checkpoint.h"

namespace rubble {

class World;
struct WorldOptions;

enum class Schedule {
  layers,  // a layer falls when the previous one is at rest
  planes,  // a layer falls when every piece of the previous one has touched something
};

struct SettleOptions {
  Schedule schedule = Schedule::layers;
  double gravity = 9.81;            // unit: m/s2, downwards
  double step = 1.0 / 60.0;         // unit: s; range: 1/1000 to 1/30
  double rest_speed = 0.05;         // a piece rests below both limits; unit: m/s
  double rest_angular_speed = 0.2;  // unit: rad/s
  // A pile with a deeper overlap is not settled; see PileState::deepest_overlap. unit: m
  double rest_overlap = 0.005;
  double layer_time_limit = 4.0;    // longest time between two layers; unit: s
  double final_time_limit = 60.0;   // after the last layer; unit: s
  double lost_below = -0.5;         // a piece with a lower centre of mass has left the world; unit: m
  double lost_beyond = 100.0;       // so has a piece farther than this from the Z axis; unit: m
  int threads = 0;                  // 0: all processors; the result does not depend on it

  void validate() const;  // throws InputError naming the field
};

struct SettleProgress {
  int layer = 0, layers = 0;  // layers spawned so far, of all
  double layer_time = 0;      // simulated since the last spawn; unit: s
  double simulated = 0;       // unit: s
  int pieces = 0, awake = 0;
  bool verifying = false;     // rest is being verified: motionless pieces may be awake
  CollapseReport collapse;    // of a building, so far
  // Makes a checkpoint of this moment; may be called in the callback only. Empty while a building collapses: its
  // stresses are not saved, so settling starts again.
  std::function<SettleCheckpoint()> make_checkpoint;
};
// Called after each step; return false to stop early (the state is then not settled).
using SettleCallback = std::function<bool(const SettleProgress&)>;

// Observes the world without changing it: before each step (after the pieces of a new layer were added), and once at
// the end, unless settling is stopped early. So a run that is stopped and resumed is observed as often as a run
// without a stop.
using WorldObserver = std::function<void(const World&)>;

// Runs until every piece rests or a time limit comes. Same input, same bits.
PileState settle_pile(const Pile& pile, const SettleOptions& options = {},
                      const SettleCallback& progress = {}, const WorldObserver& observe = {});
// The same in a world of the caller, which can be used in the callback and afterwards.
// world: empty, with the types and assemblies of the pile and calc_world_options(options).
PileState settle_pile(World& world, const Pile& pile, const SettleOptions& options = {},
                      const SettleCallback& progress = {}, const WorldObserver& observe = {});
// Continues from a checkpoint of the same pile and options; only the number of threads may differ. The result is
// that of a run without a stop, bit for bit. Throws InputError for a checkpoint of other work.
PileState resume_settling(const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options = {}, const SettleCallback& progress = {},
                          const WorldObserver& observe = {});
PileState resume_settling(World& world, const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options = {}, const SettleCallback& progress = {},
                          const WorldObserver& observe = {});
// Of a world in which this pile has settled, or was stopped, and what was done to it since: resuming asks again whether
// all of it rests. Not while a building collapses, whose stresses are not saved: its bodies would not break any more.
SettleCheckpoint make_rest_checkpoint(const World& world, const Pile& pile, const SettleOptions& options);
WorldOptions calc_world_options(const SettleOptions& options);

}  // namespace rubble
