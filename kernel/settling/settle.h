// Settling: from a Pile to a checked rest.
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
  layers,  // a layer falls when the one before is at rest
  planes,  // a layer falls when every piece of the one before has touched something
};

struct SettleOptions {
  Schedule schedule = Schedule::layers;
  double gravity = 9.81;            // unit: m/s2, downwards
  double step = 1.0 / 60.0;         // unit: s; range: 1/1000 to 1/30
  double rest_speed = 0.05;         // a piece rests below both limits; unit: m/s
  double rest_angular_speed = 0.2;  // unit: rad/s
  // A pile with a deeper overlap is not settled; `deepest_overlap` says who. unit: m
  double rest_overlap = 0.005;
  double layer_time_limit = 4.0;    // the next layer comes at the latest then; unit: s
  double final_time_limit = 20.0;   // after the last layer; unit: s
  double lost_below = -0.5;         // a piece whose centre of mass is lower has left the world; unit: m
  double lost_beyond = 100.0;       // likewise farther than this from the Z axis; unit: m
  int threads = 0;                  // 0: all processors; the result does not depend on it

  void validate() const;  // throws InputError naming the field
};

struct SettleProgress {
  int layer = 0, layers = 0;  // layers spawned so far, of all
  double layer_time = 0;      // simulated since the last spawn; unit: s
  double simulated = 0;       // unit: s
  int pieces = 0, awake = 0;
  bool verifying = false;     // rest is verified: those that stay in place may be awake, too
  CollapseReport collapse;    // of a building, so far
  // Makes a checkpoint of this moment; may be called in the callback only. Empty where there is a
  // building: what was computed of its stresses is not kept, and settling starts anew.
  std::function<SettleCheckpoint()> make_checkpoint;
};
// Called after each step; return false to stop early (the state is then not settled).
using SettleCallback = std::function<bool(const SettleProgress&)>;

// Looks at the world without changing it: before each step, when the pieces of a new layer are there
// already, and once at the end; not at the end of a settling that is stopped early. So the looks of one
// that is stopped and resumed are together those of one that is not.
using WorldObserver = std::function<void(const World&)>;

// Runs until every piece rests or a time limit comes. Same input, same bits.
PileState settle_pile(const Pile& pile, const SettleOptions& options = {},
                      const SettleCallback& progress = {}, const WorldObserver& observe = {});
// The same in a world of the caller's, who may look at it in the callback and go on from its end.
// world: empty, with the types and assemblies of the pile and calc_world_options(options).
PileState settle_pile(World& world, const Pile& pile, const SettleOptions& options = {},
                      const SettleCallback& progress = {}, const WorldObserver& observe = {});
// Continues from a checkpoint of the same pile and options; only the threads may differ. Equals
// never having stopped, bit for bit. Throws InputError for a checkpoint of other work.
PileState resume_settling(const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options = {}, const SettleCallback& progress = {},
                          const WorldObserver& observe = {});
PileState resume_settling(World& world, const SettleCheckpoint& checkpoint, const Pile& pile,
                          const SettleOptions& options = {}, const SettleCallback& progress = {},
                          const WorldObserver& observe = {});
WorldOptions calc_world_options(const SettleOptions& options);

}  // namespace rubble
