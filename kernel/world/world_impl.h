// The inside of World: its data and the stages of a step. Not for use outside kernel/.
#pragma once

#include <deque>
#include <functional>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/collision/body.h"
#include "kernel/collision/broad_phase.h"
#include "kernel/collision/contact.h"
#include "kernel/collision/narrow_phase.h"
#include "kernel/multibody/simbody_blocks.h"
#include "kernel/multibody/simbody_trees.h"
#include "kernel/multibody/tree_motion.h"
#include "kernel/solver/contact_solver.h"
#include "kernel/world/world.h"

namespace rubble {

// Which bodies are a robot: those from `first_body` on, in the order of its links.
struct WorldRobot {
  std::int32_t tree = 0, first_body = 0;
  // Of a tube: how many of its links have grown, how far the tip has come beyond them (unit: m), and the
  // curvature of what grows now (unit: 1/m).
  std::int32_t laid = 0;
  double reached = 0, curve_left = 0, curve_up = 0;
};

// Pieces that hold together: one rigid body.
struct RigidGroup {
  std::vector<std::int32_t> members;  // ascending; the first one leads. Empty: there is no such group
  Vec3f reach;                        // largest |x|, |y|, |z| of any corner; unit: m
};

// A tie as the solver sees it: a contact between its anchors that pulls.
struct Tie {
  TieState state;
  Contact contact;    // of the bodies that its pieces move with
  float order = 1e30F;  // height that decides its place in the solver's order; unit: m
  bool solved = false;  // took part in the last step
};

// What a snapshot holds: all that changes from step to step.
struct WorldData {
  std::vector<Body> bodies;
  std::vector<Collider> colliders;
  std::vector<Vec3f> corners;  // turned to the world, from the centre of mass of their piece
  BroadPhase broad;
  std::vector<Pair> pairs;        // of parts that are near each other
  std::vector<Contact> contacts;  // one per pair
  std::unordered_map<std::uint64_t, std::int32_t> contact_of_pair;  // looked up, never walked
  std::vector<std::uint8_t> wake_next;                              // by body
  std::vector<Tree> trees;          // those that came apart keep their place, without links
  std::vector<WorldRobot> robots;
  std::vector<RigidGroup> groups;   // those that came apart keep their place
  std::vector<Tie> ties;            // that hold
  double tie_energy = 0;            // see World::tie_energy(); unit: J
  std::int64_t steps = 0;
  std::int64_t verification_steps = -1;  // since begin_rest_verification(); -1: no verification
  std::int64_t all_awake_since = -1;  // in verification_steps; -1: some pieces doze
  int lost = 0;
};

// What the search for pairs asks of every piece in every step, close together in memory.
struct Sweep {
  Vec3f linear;        // unit: m/s
  float turning = 0;   // angular speed times radius; unit: m/s
  float reach = 0;     // no point goes farther in this step; unit: m
  bool awake = false;
};

// Where a contact stands in the solver's order.
struct OrderKey {
  float height = 0;  // unit: m
  std::int32_t collider_a = 0, collider_b = 0;
  std::int32_t index = 0;  // of the pair; decides nothing

  bool operator<(const OrderKey& k) const {
    return std::tie(height, collider_a, collider_b) < std::tie(k.height, k.collider_a, k.collider_b);
  }
};

// Two parts that overlap too deep.
struct DeepPair {
  std::int32_t body_a = 0, body_b = 0;
  std::int32_t collider_a = 0, collider_b = 0;
  std::int32_t index = 0;  // of the pair; decides nothing

  bool operator<(const DeepPair& p) const {
    return std::tie(body_a, body_b, collider_a, collider_b) <
           std::tie(p.body_a, p.body_b, p.collider_a, p.collider_b);
  }
};

struct World::Impl {
  Impl(std::vector<PieceType> piece_types, const WorldOptions& world_options,
       std::vector<AssemblyType> assembly_types);

  std::vector<PieceType> types;  // those of the links of robots come last
  int placeable_types = 0;       // the others
  std::vector<AssemblyType> assemblies;
  std::deque<Shape> shapes;      // by type; bodies point at them
  std::vector<RobotModel> robots;
  std::vector<Tree> grown_robots;  // by robot: of a tube, the tree when all of it has grown
  WorldOptions options;
  SolverSettings solver_settings;
  NarrowSettings narrow_settings;
  ThreadPool pool;
  WorldData data;
  SimbodyBlocks blocks;
  SimbodyTrees simbody_trees;
  ContactSolver solver;
  StepTimes times;
  std::function<bool()> on_solved;  // see World::set_on_solved()

  // Scratch of a step.
  std::vector<std::int32_t> awake_bodies;  // those that take part in the step, ascending
  std::vector<std::int32_t> active;
  std::vector<std::int32_t> surfaces;  // the bodies that are one, ascending
  std::vector<Sweep> sweeps;                // by body
  std::vector<std::uint8_t> leaves_box;     // by collider
  std::vector<std::uint8_t> pair_states;    // by pair: a PairState
  std::vector<OrderKey> order_keys, key_scratch;
  std::vector<DeepPair> deep_pairs;
  std::vector<std::uint8_t> overlapping, slept, disturbed;  // by body
  std::vector<Vec3f> lost_support;               // by body: of sleepers, to awake neighbours
  std::vector<std::int32_t> unsettled;           // sleepers whose lost_support is not zero
  std::vector<std::uint8_t> is_deep;             // by pair: overlaps deeper than sleep allows
  std::vector<std::uint8_t> may_be_stuck;        // by pair: is_stuck(), or was led out before
  std::vector<std::uint8_t> block_awake;
  std::vector<std::int32_t> body_of;  // by number in SimbodyBlocks
  std::vector<std::uint8_t> moves;  // by number in SimbodyBlocks
  std::vector<Motion> velocities, displacements;
  std::vector<BodyRates> rates;  // by number in SimbodyBlocks
  float lateness = 0;  // see calc_lateness()
  std::vector<float> fastest;
  std::vector<std::uint8_t> rolling;  // by body, see find_rolling()
  std::vector<std::int32_t> neighbour;
  std::vector<TreeMotion> tree_motions;       // by number of the tree
  std::vector<std::int32_t> awake_trees;
  std::vector<std::uint8_t> is_solved;        // by number of the tree
  std::vector<std::int32_t> released;  // a body of each joint that broke in this step
  SolvedTrees solved_trees;
  std::vector<std::int32_t> tie_order;  // ties in the solution, in their order

  // world.cpp
  void add_body(const NewPiece& piece, FreeBody* free);
  void weigh(Body& body) const;  // a piece alone, by its type
  void mirror(Body& body);   // q and u from Simbody
  void refresh(Body& body);  // rotation, inertia, corners, boxes
  void add_to_blocks(int first, const std::vector<FreeBody>& free);
  void introduce(int first);  // bodies from there on to all others
  void find_first_pairs(int body);
  void list_surfaces();
  Vec3 linear_velocity(const Body& body) const;
  Vec3 angular_velocity(const Body& body) const;
  PosedBody posed(const Collider& collider) const;

  // world_pairs.cpp
  void find_pairs();
  void select_pairs();
  void update_contacts();
  void update_pair(Pair& pair, Contact& contact);
  void note_overlap(std::int32_t pair);
  void list_awake();
  void note_sweeps();
  Aabb calc_swept_box(int collider) const;
  std::uint8_t classify(const Pair& pair) const;
  bool is_near(const Pair& pair) const;
  float calc_margin(int body_a, int body_b) const;  // body_b may be kGround
  bool may_touch(const Pair& pair) const;
  void add_contact(int collider_a, int collider_b);
  void push_contact(const Pair& pair);
  void remove_contact(std::size_t index);
  void update_surface_pairs(int collider);
  void update_surface_slots(const Pair& first);

  // world_overlaps.cpp
  void lead_out();
  bool is_stuck(const Contact& contact) const;
  void lead_out_of(const std::vector<std::int32_t>& deep);
  std::vector<PosedPart> posed_parts(const Body& body) const;

  // world_sleep.cpp
  void wake_marked();
  void wake_hit();
  void update_sleep();
  void wake_changed();
  bool is_unbalanced(const Body& body, const Vec3f& change) const;
  void note_lost_contact(const Contact& contact);
  void put_to_sleep();
  bool within_rest_tolerance(const Body& body) const;
  static bool overlaps_deep(const Contact& contact);  // too deep to fall asleep soon
  void find_overlapping();
  void note_loads();
  void wake(int body);
  static void wake_one(Body& body);
  void fall_asleep(int body);
  float wake_impulse(const Body& body) const;  // a contact's must change by this; unit: N s

  // world_verification.cpp
  void update_verification();
  int mark_restless();
  void spread_disturbance();
  void doze();
  void wake_dozing();

  // world_groups.cpp
  template <typename Action>
  void each_collider(const Body& body, Action&& action) const;
  Body& acting(int piece);
  const Body& acting(int piece) const;
  const Vec3f& reach_of(const Body& body) const;
  double collider_friction(std::int32_t collider) const;
  void bind(int first, int count);
  void split(int lead, const std::vector<SplitPart>& parts);
  void form_group(const SplitPart& part, const Body& whole);
  void set_free(const std::vector<SplitPart>& parts, const Body& whole, const Vec3& linear,
                const Vec3& angular);
  void weigh(Body& body, const RigidGroup& group);
  void move_contacts(const Vec3& old_centre, int old_lead);
  void refresh_group(Body& body);

  // world_ties.cpp
  void add_tie(const TieState& tie);
  Vec3f find_anchor(std::int32_t piece, const Vec3& anchor) const;
  double pose_tie(Tie& tie) const;
  template <typename Action>
  void each_solved(Action&& action);
  void begin_ties();
  void end_ties();
  void bend_ties();
  std::vector<std::pair<std::int32_t, std::int32_t>> find_pressed_deep() const;
  void stretch_ties();
  void lose_ties();

  // world_step.cpp
  void find_contacts();
  void solve();
  void apply_forces();
  void solve_contacts();
  void sort_by_height();
  void update_touching();
  void advance();
  void set_rates(std::size_t body);
  double calc_travel(const Body& body) const;
  void remove_lost();
  void lose(int body);

  // world_limits.cpp
  void return_clamped_momentum(std::size_t piece, const Vec3f& speed);
  void clamp_ejection_velocity();
  float calc_lateness() const;
  float keep_of_late_spin(const Body& body, const Vec3f& angular, float spin) const;
  static float calc_most_spin(const Body& body);
  void find_rolling();
  bool does_roll(std::size_t body) const;

  // world_resume.cpp
  void join_settled(const Pile& pile, const PileState& state);
  void lay_to_rest(const PileState& state, const std::vector<TreeState>& trees);

  // world_robots.cpp
  int add_robot(const RobotModel& model, const Pose& world_from_base);
  void set_command(int robot, const RobotCommand& command);
  void wake_neighbours(std::int32_t body);
  TreeLink* find_link(const WorldRobot& robot, int link);
  bool touches_robot(const Contact& contact) const;
  bool is_driven(std::int32_t body) const;
  void stay_awake_near_robots();  // in `slept`
  bool is_of_robot(const Contact& contact, const WorldRobot& robot) const;

  // world_growth.cpp
  Tree plant_tube(const Tree& grown, const EvertingTube& tube);
  void stow(Body& body);
  void grow_tubes();
  void steer_tip(WorldRobot& robot, const EvertingTube& tube);
  void wind_back(WorldRobot& robot, const EvertingTube& tube);
  void take_link(WorldRobot& robot, const RobotModel& model, const Tree& grown);
  template <typename If>
  void drop_contacts(If condition) {
    for (std::size_t i = 0; i < data.pairs.size();) {
      if (condition(data.pairs[i])) {
        remove_contact(i);
      } else {
        ++i;
      }
    }
  }
  void lay_link(WorldRobot& robot, const RobotModel& model, const Tree& grown);
  void set_tip(const WorldRobot& robot, const RobotModel& model);
  void carry_stowed(const WorldRobot& robot, const RobotModel& model);
  double tube_length(const WorldRobot& robot, const RobotModel& model) const;

  // world_trees.cpp
  void add_assembly(const NewPiece& piece);
  Tree make_tree(const AssemblyType& assembly, const NewPiece& piece);
  void start_tree(const Tree& tree, const NewPiece& piece, const std::vector<double>& joint_positions);
  bool are_joined(int body_a, int body_b) const;
  bool is_awake(const Tree& tree) const;
  void begin_trees();
  void touch_trees();
  void advance_trees();
  void mirror_link(TreeLink& link, const Pose& world_from_com);
  void mirror_tree(int tree, const TreeMotion& motion);
  void mirror_state(int tree);
  void stop_tree(int tree);
  void keep_trees_whole();  // in `slept`
  void lose_tree(int tree);
  void set_tree_motion(int body, const Vec3& linear, const Vec3& angular);
  void set_tree_pose(int body, const Pose& world_from_com);

  // world_break.cpp
  void break_joints();
  void open_loops(int tree);
  void split_tree(int tree, const std::vector<std::uint8_t>& broken);
  void release(const TreeLink& link);
};

// The contacts of the last solution, and the ties in it.
template <typename Action>
void World::Impl::each_solved(Action&& action) {
  for (const std::int32_t index : active) action(data.contacts[index]);
  for (Tie& tie : data.ties) {
    if (tie.solved) action(tie.contact);
  }
}

// Of a group those of all its members; by number.
template <typename Action>
void World::Impl::each_collider(const Body& body, Action&& action) const {
  const auto of = [&action](const Body& piece) {
    for (int i = 0; i < piece.collider_count; ++i) action(piece.first_collider + i);
  };
  if (body.group < 0) return of(body);
  for (const std::int32_t member : data.groups[body.group].members) of(data.bodies[member]);
}

// Its members, like those of WorldData and what it holds, are listed in world_serialization.h as well.
struct World::Snapshot {
  std::uint64_t types = 0;  // hash_types() of the world's types
  WorldData data;
  std::vector<FreeBody> simbody;           // by number in SimbodyBlocks
  std::vector<std::int32_t> block_starts;  // number of each block's first body
  std::vector<TreeState> tree_states;      // by number of the tree
};

}  // namespace rubble
