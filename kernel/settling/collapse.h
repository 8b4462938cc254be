// A structure that breaks in a running world: the loads of each step give stresses, stresses give failures, and bodies
// come apart.
//
//   Structure --Collapse--> pieces in a World, bound --step--> bonds fail --split--> a ruin
//
// Anchored parts are immovable until they break; loose parts are rigid between breaks. A sudden change of load
// overshoots: a bond must carry its load at rest plus a share of the change. An impact breaks bonds only if its energy is
// sufficient.
#pragma once

#include <memory>
#include <vector>

#include "kernel/model/building.h"
#include "kernel/settling/collapse_report.h"
#include "kernel/structure/failure.h"
#include "kernel/structure/stress.h"
#include "kernel/world/world.h"

namespace rubble {

struct CollapseOptions {
  double gravity = 9.81;       // unit: m/s2
  double step = 1.0 / 60;      // of the world; unit: s
  double overshoot = 0.5;      // of a sudden change of load; 1: undamped; unit: 1; range: 0 to 1
  double continuity = 0;       // see BuildingSpec::continuity; unit: 1; range: 0 to 1
  double shake = 0;            // the largest acceleration of the ground that will come; unit: m/s2
};

// A body that is a spring before a mass: it pushes with a force that does not change while it lasts.
struct Striker {
  Vec3 direction;    // of its velocity; length 1
  double mass = 0;   // unit: kg
  double speed = 0;  // unit: m/s
  double force = 0;  // on what does not give way; unit: N
};

class Collapse {
 public:
  // Adds the structure's pieces to the world: fixed, bound, as types first_type and on. settled: forces
  // in its bonds before the cause, by bond; empty: none, and nothing overshoots.
  Collapse(World& world, const Structure& structure, int first_type, const CollapseOptions& options,
           std::vector<SectionForces> settled = {});
  ~Collapse();
  Collapse(const Collapse&) = delete;
  Collapse& operator=(const Collapse&) = delete;

  // Around each step of the world. The ground is the frame: what moves feels its acceleration backwards.
  void begin_step(const Vec3& ground_acceleration = {});  // unit: m/s2
  void end_step();
  // Every face that sees the charge gets this impulse per area at 1 m, less with the square of the distance and
  // with the cosine of its incidence. What comes off by it is thrown at the end of the next step. unit: N s/m2
  void blast(const Vec3& at, double impulse_at_1m);

  // From now on a body drives into the piece of a member that is nearest to a place, and on behind it, until
  // it has come to a stop or lost it.
  void strike(int member, const Vec3& at, const Striker& striker);
  // How far the footing under a member has sunk so far; unit: m. What stands on such footings alone goes down with
  // them; what the rest of the structure holds up stays, and so does a footing that it would have to pull.
  void sink(int member, double depth);

  bool is_sinking() const;   // something went down with its footing in the last step
  bool is_breaking() const;  // something failed in the last step: the next one may have more
  // Impacts so far that overloaded bonds but brought too little energy to break them.
  int arrests() const;
  int first_piece() const;
  int piece_count() const;
  CollapseReport report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
