// Contacts in which a tree takes part, and the stops of its joints: generalized rows in the same
// sweeps as all other contacts, so that impulses flow both ways.
//
// A row's Jacobian runs over the speeds of each side: those of a whole tree, or the six of a free
// piece. Where the two sides are links of one tree, it is one side. Arithmetic is in double
// precision, one row after another; the steps are those of contact_rows.h.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collision/body.h"
#include "kernel/collision/contact.h"
#include "kernel/multibody/tree_motion.h"
#include "kernel/solver/contact_rows.h"

namespace rubble {

struct SolverSettings;

// The trees that the contact solver moves in a step: those in contact or near a stop.
struct SolvedTrees {
  std::vector<TreeMotion>* motions = nullptr;  // by number of the tree
  std::vector<std::int32_t> trees;             // which of them, ascending
};

class TreeContacts {
 public:
  // order: the contacts with an awake link; number, share: of each body and each moving free body,
  // as ContactSolver has them.
  void begin(const SolverSettings& settings, const std::vector<Body>& bodies,
             const std::vector<std::int32_t>& order, const std::vector<Contact>& contacts,
             const std::vector<std::int32_t>& number, const std::vector<float>& share,
             const SolvedTrees& trees);
  bool empty() const { return trees_.trees.empty(); }

  void begin_substep(PaddedMotion* speeds, bool first, double weight);  // forces, warm start
  void solve_velocities(double per_substep, const PaddedMotion* moved, PaddedMotion* speeds);
  void end_substep();
  void end_substeps(double weight);

  // Returns whether anything is to be pushed.
  bool begin_pushes(const SolverSettings& settings, const PaddedMotion* moved);
  void solve_pushes(PaddedMotion* moved);
  void drop_opposed_speeds(double step);
  void store(const std::vector<Body>& bodies, std::vector<Contact>& contacts);

 private:
  struct Side {
    std::int32_t tree = -1;    // number of the tree, or
    std::int32_t number = -1;  // of a moving free body; neither: immovable
    int size = 0;              // speeds
    double push_weight = 0;
  };
  struct Row {
    std::size_t first = 0;  // of its coefficients: J, then M^-1 J^T, of one side and of the other
    double mass = 0, impulse = 0, total = 0;
  };
  struct NormalRow {
    Row row;
    double gap = 0, carried = 0, push_mass = 0, push_target = 0, push = 0;
  };
  struct Item {  // a contact or a stop
    std::int32_t contact = -1;
    Side sides[2];
    std::size_t first_row = 0;
    int rows = 0;
    double friction = 0, radius = 0;
    Vec3 normal, tangents[2], middle_a, middle_b;
    Row slide[2], twist;
  };
  // The speeds or displacements of an item's sides.
  struct View {
    double* x[2];
    double local[2][6];
  };
  class Builder;

  void add_stops(std::int32_t tree);
  void finish_row(Row& row, const Item& item) const;
  void uncouple_friction(Item& item);
  double calc_push_mass(const Row& row, const Item& item) const;
  void load(const Item& item, const PaddedMotion* free, bool displacements, View& view) const;
  static void save(const Item& item, const View& view, PaddedMotion* free);
  double relative(const Item& item, const Row& row, const View& view) const;
  void apply(const Item& item, const Row& row, double impulse, View& view) const;
  void push(const Item& item, const Row& row, double impulse, View& view) const;
  void solve_friction(Item& item, double limit, View& view);
  void solve_normals(Item& item, double per_substep, const View& moved, View& view);
  double sum_impulses(const Item& item) const;
  void carry_over(Item& item, double weight);
  void give(const std::vector<Body>& bodies, std::int32_t body, const Vec3& torque,
            const Vec3& force);

  SolvedTrees trees_;
  std::vector<Item> items_;
  std::vector<NormalRow> rows_;
  std::vector<double> coefficients_;
};

}  // namespace rubble
