#include "bench/equilibrium/pile_balance.h"

#include <cmath>

#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

class Maker {
 public:
  Maker(const Pile& pile, const PileState& state, double gravity)
      : pile_(pile), state_(state), gravity_(gravity), bodies_(state.pieces.size(), kImmovable) {
    for (std::size_t i = 0; i < pile.types.size(); ++i)
      volumes_.push_back(compile_shape(pile.types[i], pile.types[i].name).volume);
  }

  PileBalance make(double tolerance) {
    for (std::size_t i = 0; i < state_.pieces.size(); ++i) add_body(int(i));
    const std::vector<DesignedJoint> joints = find_designed_joints(pile_, state_);
    for (const DesignedJoint& joint : joints) add_joint(joint);
    for (const TouchPoint& touch :
         find_touch_points(pile_.types, state_, find_pairs_apart(joints), tolerance))
      add_contact(touch);
    return std::move(made_);
  }

 private:
  const PieceType& type_of(int piece) const {
    return pile_.types[std::size_t(state_.pieces[std::size_t(piece)].type)];
  }

  void add_body(int piece) {
    const PieceState& p = state_.pieces[std::size_t(piece)];
    if (p.status == PieceStatus::fixed || p.status == PieceStatus::lost) return;
    const VolumeProperties& v = volumes_[std::size_t(p.type)];
    const double s = p.scale;
    BalanceBody body;
    body.centre = p.world_from_body * (v.centre_of_mass * s);
    body.weight = type_of(piece).density * v.volume * s * s * s * gravity_;
    const double trace = v.inertia.rows[0].x + v.inertia.rows[1].y + v.inertia.rows[2].z;
    body.length = s * std::sqrt(0.5 * trace / v.volume);
    body.force = {0, 0, -body.weight};
    bodies_[std::size_t(piece)] = int(made_.problem.bodies.size());
    made_.problem.bodies.push_back(body);
    made_.pieces.push_back(piece);
  }

  int body_of(int piece) const {
    return piece == kGroundPiece ? kImmovable : bodies_[std::size_t(piece)];
  }

  void add_contact(const TouchPoint& touch) {
    made_.touches.push_back(touch);
    const double on_b = type_of(touch.b).friction;
    // The ground has the friction of what lies on it: coefficients are against concrete.
    const double on_a = touch.a == kGroundPiece ? on_b : type_of(touch.a).friction;
    made_.problem.contacts.push_back({body_of(touch.a), body_of(touch.b), touch.point,
                                      touch.normal, std::sqrt(on_a * on_b)});
  }

  void add_joint(const DesignedJoint& joint) {
    const JointLoad load = calc_joint_load(joint, state_);
    const int parent = body_of(joint.state->parent), child = body_of(joint.state->child);
    for (BalanceReaction reaction : load.reactions) {
      reaction.a = parent, reaction.b = child;
      made_.problem.reactions.push_back(reaction);
    }
    add_load(child, load.spring_force, load.spring_torque, load.point);
    add_load(parent, -load.spring_force, -load.spring_torque, load.point);
  }

  void add_load(int i, const Vec3& force, const Vec3& torque, const Vec3& point) {
    if (i == kImmovable) return;
    BalanceBody& body = made_.problem.bodies[std::size_t(i)];
    body.force += force;
    body.torque += torque + cross(point - body.centre, force);
  }

  const Pile& pile_;
  const PileState& state_;
  double gravity_;
  std::vector<VolumeProperties> volumes_;  // by type
  std::vector<int> bodies_;                // by piece
  PileBalance made_;
};

}  // namespace

PileBalance make_pile_balance(const Pile& pile, const PileState& state, double gravity,
                              double tolerance) {
  return Maker(pile, state, gravity).make(tolerance);
}

}  // namespace rubble
