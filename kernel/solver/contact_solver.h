// Impulses at the contacts of a step: projected Gauss-Seidel on velocities in substeps, each
// warm-started from the one before (Catto 2005; Macklin et al. 2019, "Small steps"), with Coulomb
// friction and twist at the middle of each manifold. Normals and arms stay those of the step's
// start; separations follow the motion. Overlaps are then pushed apart by displacements that never
// enter the velocities.
//
// Contacts are packed sixteen to a batch such that within a batch no moving body appears twice and
// that contacts of one body keep their order: the result is that of solving them one by one.
#pragma once

#include <vector>

#include "kernel/base/disjoint_sets.h"
#include "kernel/base/parallel.h"
#include "kernel/collision/body.h"
#include "kernel/collision/contact.h"
#include "kernel/solver/contact_colours.h"
#include "kernel/solver/contact_rows.h"
#include "kernel/solver/sweep_plan.h"
#include "kernel/solver/sweep_progress.h"
#include "kernel/solver/tree_contacts.h"

namespace rubble {

struct SolverSettings {
  float step = 1.0F / 60;        // unit: s
  float gravity = 9.81F;         // unit: m/s2, downwards
  int substeps = 16;             // one sweep each
  int position_iterations = 8;
  float rest_gap = 0.001F;       // surfaces come to rest this far apart, so that normals are exact; m
  // Position error that is left alone, so that contacts do not chatter: less than the rest gap, so a
  // pile rests without any overlap. With none left alone a pile creeps, as pushes know no friction;
  // with 1.5 mm nothing brings a stack upright again that leans within it. unit: m
  float slop = 0.0003F;
  float position_fraction = 0.2F;  // of an overlap removed per step
  float maximum_push = 0.02F;    // unit: m per step
  float fading = 0;              // pushes are weaker by this share, but for overlaps deeper than `deep`
  float deep = 0.004F;           // with such an overlap no pile counts as settled; unit: m
};

// Six numbers per body.
struct Motion {
  Vec3f linear, angular;
};

class ContactSolver {
 public:
  // Solves the contacts in `order` (indices into `contacts`). `velocities` (by body) hold the
  // speeds at the start of the step and are changed to those at its end; `displacements` receive
  // the motion of the step, position correction included. Both are meaningful for bodies with a
  // contact only. Immovable and sleeping bodies have infinite mass. Links of trees are moved by
  // their trees' motions instead; every awake tree with a contact must be among `trees`.
  void solve(const SolverSettings& settings, const std::vector<Body>& bodies,
             const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
             std::vector<Motion>& velocities, std::vector<Motion>& displacements,
             const SolvedTrees& trees, ThreadPool& pool);

  // Whether the last solve() moved a piece otherwise than its weight does, impulses aside: by pushes, or
  // as it counted as heavier than it is (see share_inertia).
  bool has_intervened(std::int32_t body) const;

  // What so many threads would gain in the sweeps of the last solve(), over contacts of bodies that are awake now.
  SweepFigures plan_sweeps(int threads, const std::vector<Body>& bodies) const;

 private:
  class Sweeper;

  // What planning asks of a contact, in the order of solving, close together in memory.
  struct Head {
    std::int32_t contact = 0, body_a = 0, body_b = 0, count = 0;
    Vec3f normal;       // from A to B
    bool tree = false;  // with an awake link of a tree
  };

  // What a plan is made of: numbers of moving bodies, or beyond them.
  struct Touch {
    std::int32_t contact, a, b, rows;

    bool operator==(const Touch& t) const {
      return contact == t.contact && a == t.a && b == t.b && rows == t.rows;
    }
  };

  void note_heads(const std::vector<Body>& bodies, const std::vector<std::int32_t>& order,
                  const std::vector<Contact>& contacts, const SolvedTrees& trees,
                  ThreadPool& pool);
  void number_bodies(const std::vector<Body>& bodies);
  void find_supported();
  // Something immovable is among what it touches.
  bool is_supported(std::int32_t number) const { return supported_[std::size_t(number)] != 0; }
  void share_inertia(const std::vector<Body>& bodies);
  int choose_domain_count(ThreadPool& pool);
  void divide(const std::vector<Body>& bodies);
  void note_places(const std::vector<Body>& bodies);
  bool note_touches();  // true: the plan has the same
  void pack();
  void note_bodies(const std::vector<Body>& bodies);
  void note_motions(const std::vector<Motion>& velocities);
  void pack_and_note(const std::vector<Body>& bodies, const std::vector<Motion>& velocities, ThreadPool& pool);
  std::size_t slot_count() const;  // moving bodies, and what does not move
  BatchRange range(int begin, int end);
  // Calls action(range) for ranges that cover all batches, on the threads of the pool.
  template <typename Action>
  void each_batch(ThreadPool& pool, Action&& action);
  void run_substeps(const SolverSettings& settings, ThreadPool& pool);
  void solve_position_constraints(const SolverSettings& settings, ThreadPool& pool);
  void push(int batch);
  bool is_pushed(const ContactBatch& batch) const;
  void cancel_correction_velocity(const SolverSettings& settings, ThreadPool& pool);
  void store(const ContactBatch& batch, std::vector<Contact>& contacts) const;

  std::vector<Head> heads_;
  std::vector<std::int32_t> tree_order_;  // contacts with a tree
  TreeContacts tree_contacts_;
  std::vector<std::int32_t> moving_;   // awake free bodies with a contact, by domain
  std::vector<std::int32_t> number_;   // of each body in moving_; moving_.size(): does not move
  DisjointSets touching_;              // what touches; by moving body, then what stays
  std::vector<std::uint8_t> supported_;  // by moving body
  std::vector<std::uint8_t> held_;     // something is below it; by moving body
  std::vector<Vec3f> backed_;          // sum of the normals to what does not move; by moving body
  std::vector<float> share_;           // of true inertia in what the solver uses, by moving body
  const RowKernels& kernels_ = best_row_kernels();
  std::vector<BodyTerms> terms_;       // by moving body
  std::vector<PaddedMotion> speeds_, moved_, before_push_;
  std::vector<ContactBatch> batches_;
  std::vector<NormalRow> rows_;
  std::vector<PushRow> pushes_;               // by row
  std::vector<std::uint8_t> wants_push_;      // by batch
  std::vector<std::uint8_t> pushed_;          // by moving body
  std::vector<Touch> touches_, planned_;      // of the plan before, and of this one
  std::vector<std::uint8_t> planned_domains_; // by moving body
  ContactColours colours_;
  SweepPlan plan_;
  int domain_count_ = 1;
  std::vector<float> places_, sorted_places_;  // by moving body
  std::vector<std::uint8_t> domains_;         // by moving body
  std::vector<std::int32_t> domain_starts_;   // numbers of each domain's first moving body; the end
};

}  // namespace rubble
