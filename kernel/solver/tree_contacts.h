// Contacts in which a tree takes part, the stops of its joints and the joints that close loops: in
// the same sweeps as all other contacts, so that impulses flow both ways.
//
// A row has a spatial Jacobian for each of its two sides, which are links of trees or free pieces:
// solving one costs the same in a tree of any size. What an impulse on a link does to its tree is
// LinkMotions' affair. Arithmetic is in double precision, one row after another; the law is that of
// contact_law.h.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collision/body.h"
#include "kernel/collision/contact.h"
#include "kernel/multibody/tree_motion.h"
#include "kernel/solver/contact_rows.h"
#include "kernel/solver/friction_axes.h"

namespace rubble {

struct SolverSettings;

// The trees that the contact solver moves in a step: those in contact, near a stop or with loops.
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
  void store(const std::vector<Body>& bodies, std::vector<Contact>& contacts);

 private:
  struct Side {
    std::int32_t tree = -1, link = -1;  // of a tree, or
    std::int32_t number = -1;           // of a moving free body; neither: immovable
    const SpatialMatrix* response = nullptr;  // of a link
    double push_weight = 0;
    double inverse_mass = 0;            // of a free body
    Mat3 inverse_inertia;
    Vec3 arm;  // from the reference of its spatial vectors to the centre of mass
  };
  // The speeds or displacements of an item's sides, and the impulses on them.
  struct View {
    Spatial x[2], impulse[2];
  };
  struct Row {
    Spatial jacobian[2], response[2];  // J; M^-1 J^T
    double mass = 0, impulse = 0, total = 0;

    // Sides: of the first only, or of both.
    template <int sides>
    RUBBLE_INLINE double relative(const View& view) const {
      const double first = dot(jacobian[0], view.x[0]);
      return sides == 1 ? first : first + dot(jacobian[1], view.x[1]);
    }
    template <int sides>
    RUBBLE_INLINE void apply(double change, View& view) const {
      for (int s = 0; s < sides; ++s) {
        view.x[s].add_scaled(response[s], change);
        view.impulse[s].add_scaled(jacobian[s], change);
      }
    }
    template <int sides>
    RUBBLE_INLINE double couple(const Row& other) const {
      const double first = dot(jacobian[0], other.response[0]);
      return sides == 1 ? first : first + dot(jacobian[1], other.response[1]);
    }
  };
  struct NormalRow {
    Row row;
    double gap = 0, carried = 0, push_mass = 0, push_target = 0, push = 0;
    Vec3 from_a, from_b;  // of the point, from the centres of mass
  };
  enum class Kind : std::uint8_t { contact, stop, loop, dry, motor };  // dry friction in a joint
  struct Item {
    Kind kind = Kind::contact;
    std::int32_t source = -1;  // index of the contact; of the loop or the link in its tree
    Side sides[2];
    int moving = 2;            // 1: the second side does not move
    bool loaded = false;       // of a tree that carries what is heavier than the link under it
    std::int32_t cross = -1;   // both sides in one tree: index of what each feels of the other
    std::size_t first_row = 0;
    int rows = 0;
    double friction = 0, radius = 0;  // a coefficient; of a joint: impulse of a substep at most
    double owed = 0;                  // as ContactBatch::owed
    Vec3 normal, tangents[2];
    double belt[2] = {};  // along the tangents, of the surface of B less that of A; unit: m/s
    Row slide[2], twist;
    PlaneTurn<double> axes{1, 0};  // from the tangents to the axes of friction, which the masses of `slide` are of
    double slide_matrix[3] = {}, slide_inverse[3] = {};  // of driven ones: J M^-1 J^T of the two, symmetric
    bool driven = false;  // a contact of a robot: see solve_driven_friction()
    bool one_way = false; // it can slide along one line only
    Spatial total[2];  // impulse of the step, where joints may break
  };
  class Builder;

  void add_stops(std::int32_t tree);
  void add_dry_friction(std::int32_t tree);
  void add_motors(std::int32_t tree);
  void add_loops(const std::vector<Body>& bodies, std::int32_t tree);
  // By tree, bottom up, and along each tree: the focus of LinkMotions then seldom goes far.
  void sort_items(const std::vector<Body>& bodies, const std::vector<std::int32_t>& order,
                  const std::vector<Contact>& contacts);
  void mark_loaded(const std::vector<Body>& bodies, const std::vector<std::int32_t>& order,
                   const std::vector<Contact>& contacts);
  Side link_side(std::int32_t tree, std::int32_t link) const;
  void couple_sides(Item& item);
  Row make_row(const Item& item, const Spatial& a, const Spatial& b) const;
  void set_row(const Item& item, const Spatial& a, const Spatial& b, Row& row) const;
  double calc_push_mass(const Item& item, const Row& row) const;
  void place_friction(Item& item);
  static void note_driven_slide(Item& item, double k00, double k01, double k11);
  TreeMotion& motion(std::int32_t tree) const { return (*trees_.motions)[std::size_t(tree)]; }
  void load(const Item& item, const PaddedMotion* free, bool displacements, View& view) const;
  static Spatial read(const Side& side, const PaddedMotion* free);
  void load_moved(const Item& item, const PaddedMotion* free, View& view) const;
  void save(const Item& item, const View& view, bool displacements, PaddedMotion* free) const;
  void start(const Item& item, PaddedMotion* speeds) const;
  template <int sides>
  bool solve_friction(Item& item, double limit, View& view);
  template <int sides>
  void apply_slide(Item& item, const double* slide, View& view);
  template <int sides>
  void solve_driven_friction(Item& item, double limit, View& view);
  template <int sides>
  void solve_normals(Item& item, double per_substep, const View& moved, View& view);
  template <int sides>
  void solve_item(Item& item, double per_substep, const View& moved, View& view);
  template <int sides>
  double find_first_loads(const Item& item, double* loads) const;
  template <int sides>
  void place_friction_of(Item& item);
  void solve_one(Item& item, double per_substep, const PaddedMotion* moved, PaddedMotion* speeds);
  void solve_loop(Item& item, View& view);
  void solve_dry(Item& item, View& view);
  void solve_motor(Item& item, View& view);
  double sum_impulses(const Item& item) const;
  void clamp_accumulated_impulses(Item& item, double weight);
  void note_total(Item& item);
  void store_loop(const Item& item);
  void store_motor(const Item& item);
  bool acts(const Item& item) const;

  SolvedTrees trees_;
  std::vector<Item> items_;
  std::vector<std::int32_t> sequence_;  // the items in the order of solving
  std::vector<NormalRow> rows_;
  std::vector<SpatialMatrix> crosses_;
  double substep_ = 0;  // unit: s
};

}  // namespace rubble
