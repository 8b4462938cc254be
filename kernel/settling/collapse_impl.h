// The parts of a collapse, see collapse.h. Not for use outside kernel/settling.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "kernel/settling/collapse.h"

namespace rubble {

struct Collapse::Impl {
  // A body of several pieces.
  struct Part {
    std::unique_ptr<GroupStress> stress;
    double mass = 0;
    Vec3 centre;            // in the structure's frame
    Mat3 inertia;           // about it
    std::vector<PieceLoad> solved;   // loads of the last solution, by piece of the group; empty: none yet
    std::vector<SectionForces> forces;  // of it, by bond of the group
    int calm = 0;                    // steps without a failure
    int waits = 0;                   // steps until what failed has passed its forces on
  };
  struct Touch {
    Vec3 force, point;      // in the structure's frame
    double energy = 0;      // that an impact brings; unit: J
    int other = -1;
    bool impact = false;
  };
  using Touches = std::vector<std::pair<std::int32_t, Touch>>;  // with the piece that is touched

  World& world;
  Structure structure;
  CollapseOptions options;
  int first = 0;
  std::vector<BondStatus> status;
  std::vector<std::int32_t> lead_of;  // by piece
  std::map<std::int32_t, Part> parts;  // by lead; those with bonds
  std::vector<SectionForces> settled;
  Vec3 ground_acceleration;
  std::int32_t struck = -1;  // the piece that a vehicle drives into; -1: none
  Vec3 strike_at;            // in the world; unit: m
  Vec3 struck_from;          // where that piece was before
  Striker striker;           // its speed becomes less
  double driven = 0;         // since it struck; unit: m
  int strike_steps = 0;      // the most that are to come
  bool sinks = false;        // a footing went down since the last solution
  bool rides = false;        // what stands on footings went down with them in this step
  std::map<std::int32_t, double> sinking;  // by bond to a footing that sinks: its depth; unit: m
  std::map<std::int32_t, Vec3> blasted;  // impulse of each piece that a blast broke off, in this step; unit: N s
  std::vector<std::pair<int, double>> drained;  // pieces of the world, and the energy that breaking took
  CollapseReport report;
  bool breaking = true;  // in this step
  int arrests = 0;

  // collapse_bodies.cpp: pieces, and the bodies that they make up
  Impl(World& w, const Structure& s, int first_type, const CollapseOptions& o,
       std::vector<SectionForces> before);
  void keep(const BondGroup& group, std::unique_ptr<GroupStress> whole);
  std::vector<BondGroup> groups_left_of(std::int32_t lead);
  void replace(std::int32_t lead, const std::vector<BondGroup>& groups, bool always = false);
  std::map<std::int32_t, Touches> find_touches() const;
  void tie(const std::vector<BondFailure>& failures);
  bool is_free(int piece) const;
  int lead_in_world(int piece) const;
  void set_motion(int piece, const Vec3& gained, const Vec3& angular);

  // collapse.cpp: loads
  std::vector<PieceLoad> calc_loads(std::int32_t lead, const Part& part, const Touches& touches,
                                    bool with_impacts) const;
  bool is_news(const Part& part, const std::vector<PieceLoad>& loads) const;

  // collapse_breaking.cpp: stresses, and what fails under them
  FailureOptions failure_options(const BondGroup& group) const;
  StressResult solve(Part& part, const std::vector<PieceLoad>& loads);
  double breaking_energy(const std::vector<BondFailure>& failing) const;
  bool is_arrested(std::int32_t lead, Part& part, const Touches& touches,
                   const std::vector<BondFailure>& failing);
  bool update(std::int32_t lead, const Touches& touches);
  bool on_solved();
  void settle_forces();

  // collapse_blast.cpp
  bool blow_off(const std::vector<std::int32_t>& pieces, const std::vector<Vec3>& impulses,
                std::vector<BondFailure>& failures);

  // collapse_sinking.cpp: footings that go down
  double lowered(std::int32_t piece) const;  // how far it has gone down with its footing; unit: m
  double height_above_ground(const BondGroup& group) const;
  bool stands_on_sinking_only(const BondGroup& group) const;
  bool lift(const BondGroup& group, const StressResult& result);
  void set_down(std::vector<BondGroup>& groups);
  void ride();

  // collapse_causes.cpp: what moves bodies beside contacts
  Vec3 strike_force() const;
  void knock_out();
  void strike();
  void drain();
  void throw_blasted();
  void accelerate();
};

}  // namespace rubble
