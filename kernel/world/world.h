// The physics: pieces under gravity over the ground z = 0, advanced in fixed steps.
//
// settle_pile() is a schedule on top of it; tests and benchmarks use it directly. Lengths in metres, masses in kg,
// times in s. Pieces are numbered in the order of their addition; numbers never change.
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

// Impulse on a piece at one point of a contact in the last solution, mean over the step.
struct ContactImpulse {
  int piece = 0;
  int other = -1;           // the other piece; -1: the ground
  Vec3 point;           // unit: m
  Vec3 impulse;         // on the piece; unit: N s
  double approach = 0;  // closing speed along the normal before the step; unit: m/s
};

// The stages of a step, in their order.
enum class StepStage {
  pairs,     // pairs that may touch
  points,    // contact points
  impulses,  // contact impulses
  motion,
  rest,      // speed limits, sleep, lost pieces; before the motion and after it
  none,      // between two steps
};

// Longest verification of rest if no limit is given; unit: s.
inline constexpr double kLongestVerification = 1e6;

class World {
 public:
  // Throws InputError for a type or assembly with invalid geometry, material or joints.
  World(std::vector<PieceType> types, const WorldOptions& options = {},
        std::vector<AssemblyType> assemblies = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // Adds pieces as a group; returns the number of the first one. An assembly gives as many pieces as
  // it has links, in their order. Throws InputError when a type does not exist or a scale is out of
  // range.
  int add(const std::vector<NewPiece>& pieces);

  // Puts a settled pile into an empty world with the pile's types and assemblies. Pieces keep their numbers and poses,
  // and are asleep, with their joints. Rigid bodies and ties of a collapsed building are restored; these bodies do not
  // break again. The loads of contacts are found by half a second with all pieces awake. fixed: the pile never moves.
  // Throws InputError for a state of another pile.
  void lay(const Pile& pile, const PileState& state, bool fixed = false);

  void step();
  // Changes the length of later steps, e.g. when robots are added to a settled pile. Impulses of sleeping pieces are
  // scaled. substeps: of the contact solver; range: 1 to 64. Throws InputError for a step out of range.
  void set_step(double step, int substeps);

  // Robots: driven articulated pieces, which never sleep. Their links are pieces with consecutive numbers and types
  // of their own. A piece wakes when a robot touches it.
  //
  // Returns the number of the robot. world_from_base: pose of the first link's frame. Throws InputError for an
  // invalid model.
  int add_robot(const RobotModel& model, const Pose& world_from_base);
  int robot_count() const;
  int robot_piece(int robot) const;  // the number of its first link
  const RobotModel& robot_model(int robot) const;
  // Holds until the next command. Targets are clamped to the limits of joints and belts. Throws InputError for a
  // target that is not a number.
  void set_command(int robot, const RobotCommand& command);
  RobotState robot_state(int robot) const;
  // Contacts of the last step with an impulse or an overlap, by link.
  std::vector<RobotContact> robot_contacts(int robot) const;

  // Adds an immovable surface with a type of its own, such as a street around the pile. It collides by its triangles,
  // from their front side. Returns its number. mesh: in the world; unit: m. friction: Coulomb, against concrete;
  // range: 0 to 2. Throws InputError for a mesh without area.
  int add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction);

  // Rigid bodies of several pieces: a structure before it breaks. bind() joins fixed pieces with consecutive numbers,
  // scale 1 and equal rotations. They stay fixed until split() frees some. Splitting conserves mass, momentum, angular
  // momentum and energy. `parts` must contain all pieces of the body.
  void bind(int first, int count);
  void split(const std::vector<SplitPart>& parts);
  // Ties two pieces that are not links of assemblies. While both are parts of one body, the tie carries no load.
  // Throws InputError for a tie out of range.
  void add_tie(const TieState& tie);
  std::vector<TieState> ties() const;  // unbroken, in the order of their creation
  int tie_count() const;
  double tie_energy() const;           // absorbed by yielding ties so far; unit: J
  // Force of a tie in the last step, by its index in ties(); unit: N.
  double tie_force(int index) const;
  // Velocity of the centre of mass of the rigid body of a piece; unit: m/s.
  Vec3 centre_velocity(int index) const;
  // All pieces of the rigid body of a piece, ascending.
  std::vector<int> bound_with(int index) const;
  // Called in each step after the contacts were solved and before anything moves. It returns true if it has split a
  // body. Contacts are then found and solved again, at most four times.
  void set_on_solved(std::function<bool()> on_solved);
  // Impulses of contacts and ties at pieces of rigid bodies, also of sleeping ones.
  std::vector<ContactImpulse> contact_impulses() const;
  // Of all contacts with an impulse in the last solution, once each: on the second of two pieces, or on the piece that
  // lies on the ground. Those between sleeping pieces are as they were when these fell asleep.
  std::vector<ContactImpulse> contacts() const;

  int size() const;
  int awake_count() const;
  int lost_count() const;
  std::int64_t steps() const;
  double time() const;  // simulated; unit: s

  PieceState piece(int index) const;
  Vec3 centre_of_mass(int index) const;  // in the frame of the piece's type, scaled; unit: m
  bool is_awake(int index) const;
  bool is_touching(int index) const;  // whether it had a contact in the last step
  // Sets the velocities of a piece and wakes it. Immovable pieces do not change. A link moves its whole tree as one
  // rigid body, unless the root is immovable.
  void set_velocity(int index, const Vec3& linear, const Vec3& angular);
  // An impulse on a piece at a point of the world; wakes it. A link passes it on to its tree, pieces of a rigid body to the
  // body. No effect on what is immovable or lost. unit: N s, m
  void apply_impulse(int index, const Vec3& point, const Vec3& impulse);
  // Change of the velocity of a piece at that point by an impulse of 1 N s there along X, Y, Z, as columns. Zero for what
  // is immovable or lost. unit: 1/kg
  Mat3 impulse_response(int index, const Vec3& point) const;
  // Moves a piece and wakes it and its neighbours; links as above.
  void set_pose(int index, const Pose& world_from_body);
  void wake_all();
  void set_sleeping(bool allowed);  // wakes all when false

  // Every piece sleeps, or has a contact and is below both speeds.
  bool at_rest(double speed, double angular_speed) const;
  // While a pile grows, pieces fall asleep easily, and a sleeping piece supports any weight. This wakes every piece.
  // Motionless pieces far from moving ones may sleep until nothing moves. Then all are woken again, because rest is a
  // state of all pieces at once. Sleeping must be allowed. limit: time after which verification is given up; unit: s.
  void begin_rest_verification(double limit = kLongestVerification);
  bool verifying_rest() const;
  // True if, at one moment since begin_rest_verification(), every piece was awake, below both speeds and in contact, and
  // had stayed within 0.3 mm for 0.5 s, within 1 mm for 1 s, or within 4 mm for 1 s without acceleration. So no piece
  // that slides or creeps faster than 4 mm/s passes. Rolling resistance (kernel/solver/speed_limits.h) is first switched
  // off, up to three times while there is time: pieces should rest without it.
  bool rest_verified(double speed, double angular_speed) const;
  // Whether a piece sleeps, or has stayed in place as rest_verified() requires.
  bool within_rest_tolerance(int index) const;
  // All moving pieces fall asleep at their poses. Ends a verification.
  void put_all_to_sleep();
  bool all_have_touched() const;
  // Of all pieces, or of immovable pieces and those that have had a contact; 0 without any.
  double highest_point(bool touched_only = false) const;

  std::vector<JointState> joints() const;  // unbroken
  DeepestOverlap deepest_overlap() const;         // of all contacts of the kernel
  double mass(int index) const;            // 0: immovable
  double kinetic_energy() const;    // unit: J
  double potential_energy() const;  // against z = 0, and of springs; unit: J
  Vec3 linear_momentum() const;     // unit: kg m/s
  Vec3 angular_momentum() const;    // about the origin; unit: kg m2/s

  // All data that later steps depend on, except options and threads. A restored snapshot continues with the same bits,
  // in any world with the same types (RunError otherwise), also in an empty one. kernel/world/world_snapshot.h converts
  // snapshots to bytes and back.
  struct Snapshot;
  std::shared_ptr<const Snapshot> snapshot() const;
  void restore(const Snapshot& snapshot);

  // Called at the beginning of each stage of a step, and with `none` at its end. Benches measure stages with it,
  // because a world reads no clock.
  void set_on_stage(std::function<void(StepStage)> on_stage);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
