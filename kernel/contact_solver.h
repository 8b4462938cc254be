// Impulses at the contacts of a step: projected Gauss-Seidel on velocities in substeps, each
// warm-started from the one before (Catto 2005; Macklin et al. 2019, "Small steps"), with Coulomb
// friction and twist at the middle of each manifold. Normals and arms stay those of the step's
// start; separations follow the motion. Overlaps are then pushed apart by displacements that never
// enter the velocities.
//
// Every body is a block of generalized speeds with the mass matrix of its own; for a free piece
// these are six numbers, and M^-1 J^T of a row is a linear and an angular part.
#pragma once

#include <vector>

#include "kernel/body.h"
#include "kernel/contact.h"

namespace rubble {

struct SolverSettings {
  float step = 1.0F / 60;        // unit: s
  float gravity = 9.81F;         // unit: m/s2, downwards
  int substeps = 16;
  int velocity_iterations = 1;   // per substep
  int position_iterations = 8;
  float rest_gap = 0.001F;       // surfaces are kept this far apart, so that normals stay exact; m
  float slop = 0.0005F;          // position error that is left alone; unit: m
  float position_fraction = 0.3F;  // of an overlap removed per step
  float maximum_push = 0.02F;    // unit: m per step
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
  // contact only. Immovable and sleeping bodies have infinite mass.
  void solve(const SolverSettings& settings, const std::vector<Body>& bodies,
             const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
             std::vector<Motion>& velocities, std::vector<Motion>& displacements);

 private:
  struct Row {
    Vec3f arm_a, arm_b;    // angular part of the Jacobian
    Vec3f turn_a, turn_b;  // inverse inertia times arm
    float mass = 0;        // 1 / (J M^-1 J^T)
    float gap = 0;         // separation at the step's start, less the rest gap; unit: m
    float impulse = 0, carried = 0;  // now, and at the start of the substep; unit: N s
  };
  struct Constraint {
    std::int32_t contact = 0, a = 0, b = 0, count = 0;
    float inverse_mass_a = 0, inverse_mass_b = 0, friction = 0, radius = 0;
    Vec3f normal, tangent[2];
    Row points[Contact::kMaxPoints];
    Row slide[2];
    Vec3f twist_a, twist_b;
    float twist_mass = 0, twist_impulse = 0, pressed = 0;
  };
  struct PushRow {
    float mass = 0, target = 0, push = 0;
  };

  void prepare(const SolverSettings& settings, const std::vector<Body>& bodies,
               const Contact& contact, int index, Constraint& c) const;
  static void carry_over(Constraint& c, float weight);
  static void warm_start(const Constraint& c, std::vector<Motion>& v);
  static void solve_velocity(Constraint& c, float per_substep, const std::vector<Motion>& d,
                             std::vector<Motion>& v);
  void solve_positions(const SolverSettings& settings, const std::vector<Body>& bodies,
                       std::vector<Motion>& displacements);
  static void store(const Constraint& c, Contact& contact);

  std::vector<Constraint> constraints_;
  std::vector<PushRow> pushes_;
  std::vector<std::int32_t> moving_;  // awake bodies with a contact
};

}  // namespace rubble
