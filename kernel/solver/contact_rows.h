// The inner loops of the contact solver: batches of sixteen contacts, no two of which share a moving
// body. A row is one scalar constraint with Jacobian (-n, -arm_a, n, arm_b).
//
// The loops exist three times, for any machine and for those with AVX2 or AVX-512. All give the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collision/contact.h"
#include "kernel/solver/wide.h"

namespace rubble {

// An impact begins without friction from the previous substep. If the normal impulses rise by more than
// this share, friction and normals are solved once more. Without it, a heavy slab squeezes a light wedge
// out at many times its own speed, although friction would hold it.
inline constexpr float kImpactRise = 1.0F;
inline constexpr int kMostRounds = 2;   // largest number of such rounds in a sweep
inline constexpr float kNoPush = 1e3F;  // a separation without position correction; unit: m

// Speeds, or the displacement of a step, of one body.
struct alignas(32) PaddedMotion {
  Quad linear{}, angular{};  // x y z and a zero
};

// What rows ask of a moving body; all zero for what does not move. Three rows of the matrix
// world-oriented inverse inertia, each with a number beside it.
struct alignas(64) BodyTerms {
  float row0[3] = {}, inverse_mass = 0;  // unit: 1/(kg m2), 1/kg
  float row1[3] = {}, mass = 0;          // unit: kg
  float row2[3] = {}, share = 0;         // of the true inertia in what the solver uses
};

struct ContactRow {
  Lanes3 arm_a, arm_b;    // angular part of the Jacobian
  Lanes3 turn_a, turn_b;  // inverse inertia times arm
  Lanes mass;             // 1 / (J M^-1 J^T); 0: lane not in use
};

// A normal row: it pushes only.
struct NormalRow {
  ContactRow row;
  Lanes gap;      // separation at the step's start, less the rest gap; unit: m
  Lanes impulse;  // at the start of a substep; unit: N s
};

// The position correction of a normal row; apart from it, as the sweeps over speeds do not need it.
struct PushRow {
  Lanes mass, target, push;
};

struct FrictionRow {
  ContactRow row;
  Lanes3 direction;
  Lanes impulse;
};

// Up to sixteen contacts with as many points each; `first_row` and `rows` say where their normal rows
// are.
struct ContactBatch {
  std::int32_t a[kLanes], b[kLanes];        // indices of moving bodies; one beyond: immovable
  std::int32_t contact[kLanes];             // index of the contact; -1: lane not in use
  std::int32_t first_row = 0, rows = 0;
  std::int32_t used = 0;                    // the lanes with a contact come first
  Lanes inverse_mass_a, inverse_mass_b, friction;
  Lanes radius, per_radius;                 // mean radius of the patch, and 1 over it
  Lanes push_share_a, push_share_b;         // see contact_law; 0 for immovable bodies
  Lanes push_mass_a, push_mass_b;           // share times mass, or 0
  Lanes3 normal;
  FrictionRow slide[2];
  Lanes3 twist_a, twist_b;                  // inverse inertia times the normal
  Lanes twist_mass, twist_impulse;
  // Friction that a sliding contact may still give, or gave too much, as normal impulses changed after it was solved.
  // The next substep adds it to the limit, so that their sums agree. unit: N s
  Lanes owed;
  Lanes pressed;                            // sum of normal impulses over the step
  Lanes most, highest;                      // of a row in a substep: allowed, and reached
};

// Batches that follow each other in the order of solving.
struct BatchRange {
  ContactBatch* begin = nullptr;
  ContactBatch* end = nullptr;
  NormalRow* rows = nullptr;   // of all batches
  PushRow* pushes = nullptr;
};

struct PushTerms {
  float slop = 0, fraction = 0, most = 0;  // as in SolverSettings
  float deep = 0, most_deep = 0;           // what is deeper than this is pushed by up to this; unit: m
};

struct RowKernels {
  // Fills the rows of batches whose lanes have their contacts and bodies. terms: by moving body.
  void (*prepare)(const BatchRange& range, const Contact* contacts, const BodyTerms* terms,
                  float rest_gap);
  // Applies the impulses that the batches start a substep with.
  void (*warm_start)(const BatchRange& range, PaddedMotion* v);
  // One sweep over friction, twist and normals. `moved`: displacements since the step's start. Each
  // batch then ends its substep: an impulse may double from one substep to the next and grow by
  // `weight` (a speed) times its mass. Loads build up fast, but the impulse of an impact is not given
  // twice. backwards: the points of a contact from the last to the first.
  void (*solve_velocities)(const BatchRange& range, bool backwards, float per_substep, float weight,
                           const PaddedMotion* moved, PaddedMotion* v);
  // What the points of a batch are to be pushed by; returns whether any is.
  bool (*begin_pushes)(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                       const PushTerms& terms, const PaddedMotion* moved);
  // One sweep of position correction on the displacements; returns whether any point pushes.
  bool (*solve_pushes)(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                       PaddedMotion* moved);
};

const RowKernels& portable_row_kernels();
const RowKernels& avx2_row_kernels();
const RowKernels& avx512_row_kernels();
// All that this processor can run, the portable ones first and the fastest last.
std::vector<const RowKernels*> all_row_kernels();
// Those for the processor that this runs on.
const RowKernels& best_row_kernels();

}  // namespace rubble
