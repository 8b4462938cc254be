// The physics on its own: pieces under gravity over the ground z = 0, advanced in fixed steps.
//
// settle_pile() is a schedule on top of it; tests and benchmarks use it directly. Lengths in
// metres, masses in kg, times in s. Pieces are numbered in the order they were added, for ever.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "kernel/model/world_input.h"

namespace rubble {

// What a piece got at one point of a contact in the last solution, mean over the step.
struct ContactImpulse {
  int piece = 0;
  int other = -1;           // the piece that gave it; -1: the ground
  Vec3 point;           // unit: m
  Vec3 impulse;         // on the piece; unit: N s
  double approach = 0;  // speed of the two against each other before, along the normal; unit: m/s
};

// The stages of a step, in their order.
enum class StepStage {
  pairs,     // who may touch whom
  points,    // where they touch
  impulses,  // what they give each other
  motion,
  rest,      // limits, sleep, what is lost; before the motion and after it
  none,      // between two steps
};

// As long as a verification of rest may take where no limit is given; unit: s.
inline constexpr double kLongestVerification = 1e6;

class World {
 public:
  // Throws InputError for a type or assembly whose geometry, material or joints are not valid.
  World(std::vector<PieceType> types, const WorldOptions& options = {},
        std::vector<AssemblyType> assemblies = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // Adds pieces as a group; returns the number of the first one. An assembly gives as many pieces as
  // it has links, in their order. Throws InputError when a type does not exist or a scale is out of
  // range.
  int add(const std::vector<NewPiece>& pieces);

  // Lays a pile that has settled into an empty world with the pile's types and assemblies, every piece
  // where it was, asleep, with its joints, and what holds together of a building as the rigid bodies and ties that it
  // came to; those bodies break no more. Pieces keep their numbers. What each contact carries is found by
  // letting all of them be awake for half a second. fixed: nothing of it ever moves. Throws InputError for
  // a state of another pile.
  void lay(const Pile& pile, const PileState& state, bool fixed = false);

  void step();
  // Changes the length of the steps to come, e.g. when robots are put into a pile that has settled. What
  // sleepers carry goes with it. substeps: of the contact solver, range 1 to 64. Throws InputError for a
  // step out of range.
  void set_step(double step, int substeps);

  // Robots: articulated pieces that are driven, and so never sleep. Their links are pieces, numbered on
  // from the first, of types that no other piece can have. A piece that a robot touches wakes.
  //
  // Returns the robot's number. world_from_base: of the first link's frame. Throws InputError for a model
  // that is not valid.
  int add_robot(const RobotModel& model, const Pose& world_from_base);
  int robot_count() const;
  int robot_piece(int robot) const;  // the number of its first link
  const RobotModel& robot_model(int robot) const;
  // Holds until the next. Targets beyond the limits of joints and belts are taken to them. Throws
  // InputError for one that is not a number.
  void set_command(int robot, const RobotCommand& command);
  RobotState robot_state(int robot) const;
  // Of the last step, those that carry an impulse or overlap; by link.
  std::vector<RobotContact> robot_contacts(int robot) const;

  // Adds an immovable surface of a type that no other piece can have, such as a street about the pile: it collides by
  // its triangles, from the side that they face. Returns its number. mesh: in the world; unit: m. friction: Coulomb,
  // against concrete; range: 0 to 2. Throws InputError for a mesh without any area.
  int add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction);

  // Pieces that hold together as one rigid body: a structure before it breaks. bind() makes one of fixed,
  // neighbouring numbers, unscaled and turned alike; they stay fixed until split() frees some. A body
  // that comes apart keeps mass, momentum, angular momentum and energy. All pieces of the body must be in
  // `parts`.
  void bind(int first, int count);
  void split(const std::vector<SplitPart>& parts);
  // Ties two pieces that are not links of articulated ones; while both move as one it carries nothing.
  // Throws InputError for a tie out of range.
  void add_tie(const TieState& tie);
  std::vector<TieState> ties() const;  // that hold, in the order in which they were added
  int tie_count() const;
  double tie_energy() const;           // what ties that yielded took so far; unit: J
  // What a tie carried in the last step, by its place in ties(); unit: N.
  double tie_force(int index) const;
  // Of the centre of mass of all that moves as one with a piece; unit: m/s.
  Vec3 centre_velocity(int index) const;
  // The pieces that move as one with a piece, itself too; ascending.
  std::vector<int> bound_with(int index) const;
  // Called in a step when the impulses of its contacts are known and nothing has moved yet. Where it has
  // split a body it returns true, and contacts are found and solved anew, four times at most.
  void set_on_solved(std::function<bool()> on_solved);
  // At the pieces of groups only: of contacts that press and ties that pull, sleeping ones too.
  std::vector<ContactImpulse> contact_impulses() const;

  int size() const;
  int awake_count() const;
  int lost_count() const;
  std::int64_t steps() const;
  double time() const;  // simulated; unit: s

  PieceState piece(int index) const;
  Vec3 centre_of_mass(int index) const;  // in the frame of the piece's type, scaled; unit: m
  bool is_awake(int index) const;
  bool is_touching(int index) const;  // something, in the last step
  // Changes a piece's speeds and wakes it. Immovable pieces cannot be changed. A link takes its tree
  // with it as one rigid body; what hangs on an immovable root stays as it is.
  void set_velocity(int index, const Vec3& linear, const Vec3& angular);
  // Moves a piece and wakes it and its neighbours; links as above.
  void set_pose(int index, const Pose& world_from_body);
  void wake_all();
  void set_sleeping(bool allowed);  // wakes all when false

  // Every piece sleeps, or touches something and is below both speeds.
  bool at_rest(double speed, double angular_speed) const;
  // Sleep is cheap to fall into while a pile grows, and who sleeps holds up others whatever they
  // weigh. This wakes every piece. Those that stay in place, far from what still moves, may doze until
  // nothing moves; then all are woken again, as rest is that of all at once. Needs sleeping to be
  // allowed: nobody counts the time otherwise. limit: when it is given up if it has not succeeded; unit: s.
  void begin_rest_verification(double limit = kLongestVerification);
  bool verifying_rest() const;
  // Since begin_rest_verification(): every piece is awake, below both speeds, touches something, and
  // has stayed within 0.3 mm for 0.5 s, within 1 mm for 1 s, or within 4 mm for 1 s without going faster and
  // faster, all at the same time. So nothing that slides or creeps faster than 4 mm/s passes. What rolling resistance alone
  // holds (kernel/solver/speed_limits.h) is let go up to three times before it passes, while there is time.
  bool rest_verified(double speed, double angular_speed) const;
  // Whether a piece sleeps, or has stayed in place as rest_verified() demands.
  bool within_rest_tolerance(int index) const;
  // All that move fall asleep where they are. Ends a verification.
  void put_all_to_sleep();
  bool all_have_touched() const;
  // Of all pieces, or of those that have touched something and the immovable ones; 0 when none.
  double highest_point(bool touched_only = false) const;

  std::vector<JointState> joints() const;  // that hold
  DeepestOverlap deepest_overlap() const;         // of all contacts, as the kernel sees them
  double mass(int index) const;            // 0: immovable
  double kinetic_energy() const;    // unit: J
  double potential_energy() const;  // against z = 0, and of springs; unit: J
  Vec3 linear_momentum() const;     // unit: kg m/s
  Vec3 angular_momentum() const;    // about the origin; unit: kg m2/s

  // Everything that the next steps depend on, except options and threads. Restoring one and
  // repeating gives the same bits, in any world with the same types (RunError otherwise), an empty
  // one too. kernel/world/world_snapshot.h turns snapshots into bytes and back.
  struct Snapshot;
  std::shared_ptr<const Snapshot> snapshot() const;
  void restore(const Snapshot& snapshot);

  // Called when a stage of a step begins, with `none` at the end of the step: a bench measures stages with
  // it, as a world reads no clock.
  void set_on_stage(std::function<void(StepStage)> on_stage);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
