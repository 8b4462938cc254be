// The inner loops of the contact solver: four contacts at a time, no two of which share a moving
// body. A row is one scalar constraint with Jacobian (-n, -arm_a, n, arm_b).
#pragma once

#include <cstdint>

#include "kernel/solver/wide.h"

namespace rubble {

// An impact has no friction from the substep before to start with. Where the normal impulses rise by
// more than this share, friction and normals take turns once more: without it a heavy slab squeezes
// a light wedge out at many times its own speed, though friction would hold it.
inline constexpr float kImpactRise = 1.0F;
inline constexpr int kMostRounds = 2;

// Speeds, or the displacement of a step, of one body; padded for loading as two wides.
struct alignas(16) PaddedMotion {
  Wide linear{}, angular{};  // x y z and a zero
};

struct WideRow {
  Wide3 arm_a, arm_b;    // angular part of the Jacobian
  Wide3 turn_a, turn_b;  // inverse inertia times arm
  Wide mass;             // 1 / (J M^-1 J^T); 0: lane not in use
};

// A normal row: it pushes only.
struct NormalRow {
  WideRow row;
  Wide gap;      // separation at the step's start, less the rest gap; unit: m
  Wide impulse;  // unit: N s
  Wide carried;  // what the substep started from
};

// The position correction of a normal row; apart from it, as the sweeps over speeds do not need it.
struct PushRow {
  Wide mass, target, push;
};

struct FrictionRow {
  WideRow row;
  Wide3 direction;
  Wide impulse;
};

// Up to four contacts; `first_row` and `rows` say where their normal rows are.
struct ContactBatch {
  std::int32_t a[kLanes], b[kLanes];        // indices of moving bodies; one beyond: immovable
  std::int32_t contact[kLanes];             // index of the contact; -1: lane not in use
  std::int32_t first_row = 0, rows = 0;
  Wide inverse_mass_a, inverse_mass_b, friction, radius;
  Wide push_share_a, push_share_b;          // see contact_law; 0 for immovable bodies
  Wide push_mass_a, push_mass_b;            // share times mass, or 0
  Wide3 normal;
  FrictionRow slide[2];
  Wide3 twist_a, twist_b;                   // inverse inertia times the normal
  Wide twist_mass, twist_impulse;
  Wide pressed;                             // sum of normal impulses over the step
};

// Applies the impulses that the batch starts a substep with.
void warm_start(const ContactBatch& batch, const NormalRow* rows, PaddedMotion* v);

// One sweep over friction, twist and normals. `moved`: displacements since the step's start.
void solve_velocities(ContactBatch& batch, NormalRow* rows, Wide per_substep,
                      const PaddedMotion* moved, PaddedMotion* v);

// Ends a substep: an impulse may double from one substep to the next and grow by `weight` (a speed)
// times its mass. Loads build up fast, but the impulse of an impact is not given twice.
void carry_over(ContactBatch& batch, NormalRow* rows, Wide weight);

// One sweep of position correction on the displacements; returns whether any point pushes.
bool solve_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                  PaddedMotion* moved);

// The relative displacement along each normal row.
Wide calc_moved(const ContactBatch& batch, const WideRow& row, const PaddedMotion* moved);

}  // namespace rubble
