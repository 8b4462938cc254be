// Impulses at the contacts of a step: projected Gauss-Seidel on velocities, warm-started from the
// last step (Catto 2005), with Coulomb friction and twist at the middle of each manifold; then
// overlaps are pushed apart by displacements that never enter the velocities.
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
  int velocity_iterations = 16;
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
  // speeds with gravity applied and are changed; `displacements` receive the position correction of
  // this step. Immovable and sleeping bodies have infinite mass.
  void solve(const SolverSettings& settings, const std::vector<Body>& bodies,
             const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
             std::vector<Motion>& velocities, std::vector<Motion>& displacements);

 private:
  struct Row {
    Vec3f arm_a, arm_b;    // angular part of the Jacobian
    Vec3f turn_a, turn_b;  // inverse inertia times arm
    float mass = 0;        // 1 / (J M^-1 J^T)
    float bias = 0;        // lowest allowed approach speed is minus this; unit: m/s
    float impulse = 0;
  };
  struct Constraint {
    std::int32_t contact = 0, a = 0, b = 0, count = 0;
    float inverse_mass_a = 0, inverse_mass_b = 0, friction = 0, radius = 0;
    Vec3f normal, tangent[2];
    Row points[Contact::kMaxPoints];
    Row slide[2];
    Vec3f twist_a, twist_b;
    float twist_mass = 0, twist_impulse = 0;
  };
  struct PushRow {
    float mass = 0, target = 0, push = 0;
  };

  void prepare(const SolverSettings& settings, const std::vector<Body>& bodies,
               const Contact& contact, int index, Constraint& c) const;
  static void warm_start(const Constraint& c, std::vector<Motion>& v);
  static void solve_velocity(Constraint& c, std::vector<Motion>& v);
  void solve_positions(const SolverSettings& settings, const std::vector<Body>& bodies,
                       const std::vector<Contact>& contacts, const std::vector<Motion>& v,
                       std::vector<Motion>& displacements);
  static void store(const Constraint& c, Contact& contact);

  std::vector<Constraint> constraints_;
  std::vector<PushRow> pushes_;
};

}  // namespace rubble
