#include "kernel/multibody/tree_joint.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

Quat quat_at(const double* q) { return {q[0], q[1], q[2], q[3]}; }
Vec3 imaginary(const Quat& q) { return {q.x, q.y, q.z}; }

// The quaternion's turn by a small rotation vector in the outer frame.
void turn(const double* by, double* q) {
  const Quat r = quat_at(q), spin = Quat{0, by[0], by[1], by[2]} * r;
  const Quat turned = normalized(
      Quat{r.w + spin.w * 0.5, r.x + spin.x * 0.5, r.y + spin.y * 0.5, r.z + spin.z * 0.5});
  q[0] = turned.w, q[1] = turned.x, q[2] = turned.y, q[3] = turned.z;
}

// From the spring's rest to where the joint is, by the shorter way; along the parent's axes.
Quat calc_bend(const TreeLink& link, const double* q) {
  const Quat bend = quat_at(q + link.first_q) * link.rest_rotation.conjugate();
  return bend.w < 0 ? Quat{-bend.w, -bend.x, -bend.y, -bend.z} : bend;
}

bool is_single(const TreeLink& link) {
  return link.mobility == Mobility::hinge || link.mobility == Mobility::slider;
}

}  // namespace

Pose calc_joint_pose(const TreeLink& link, const double* q) {
  const double* x = q + link.first_q;
  switch (link.mobility) {
    case Mobility::free:
      return {quat_at(x), {x[4], x[5], x[6]}};
    case Mobility::ball:
      return {quat_at(x), {}};
    case Mobility::hinge: {
      const auto [s, c] = portable::sincos(0.5 * x[0]);
      return {{c, 0, 0, s}, {}};
    }
    case Mobility::slider:
      return {{}, {x[0], 0, 0}};
    default:
      return {};
  }
}

void move_joint(const TreeLink& link, const double* displacement, double* q) {
  const double* d = displacement + link.first_u;
  double* x = q + link.first_q;
  if (is_single(link)) {
    x[0] += d[0];
  } else if (link.mobility == Mobility::ball || link.mobility == Mobility::free) {
    turn(d, x);
    if (link.mobility == Mobility::free) x[4] += d[3], x[5] += d[4], x[6] += d[5];
  }
}

void add_spring(const TreeLink& link, const double* q, double* forces) {
  if (link.stiffness <= 0) return;
  double* f = forces + link.first_u;
  if (is_single(link)) {
    f[0] -= link.stiffness * (q[link.first_q] - link.rest);
  } else if (link.mobility == Mobility::ball) {
    const Vec3 torque = imaginary(calc_bend(link, q)) * (-2 * link.stiffness);
    f[0] += torque.x, f[1] += torque.y, f[2] += torque.z;
  }
}

double calc_tangent_stiffness(const TreeLink& link, const double* q, const double* u) {
  constexpr double kAtYield = 0.999;
  if (link.stiffness <= 0 || link.yield == kNever) return link.stiffness;
  const double most = kAtYield * link.yield / link.stiffness;
  const double* v = u + link.first_u;
  if (is_single(link)) {
    const double x = q[link.first_q] - link.rest;
    return std::abs(x) >= most && x * v[0] >= 0 ? 0 : link.stiffness;
  }
  const Vec3 bend = imaginary(calc_bend(link, q));
  const double outwards = bend.x * v[0] + bend.y * v[1] + bend.z * v[2];
  return 2 * norm(bend) >= most && outwards >= 0 ? 0 : link.stiffness;
}

double calc_spring_energy(const TreeLink& link, const double* q) {
  if (link.stiffness <= 0) return 0;
  if (is_single(link)) {
    const double x = q[link.first_q] - link.rest;
    return 0.5 * link.stiffness * x * x;
  }
  if (link.mobility != Mobility::ball) return 0;
  // 4 k (1 - cos(x / 2)), written so that small angles keep their digits.
  const Quat bend = calc_bend(link, q);
  const Vec3 v = imaginary(bend);
  return 4 * link.stiffness * dot(v, v) / (1 + bend.w);
}

void creep(TreeLink& link, const double* q) {
  if (link.stiffness <= 0 || link.yield == kNever) return;
  const double most = link.yield / link.stiffness;
  if (is_single(link)) {
    const double x = q[link.first_q];
    link.rest = std::min(x + most, std::max(x - most, link.rest));
  } else if (link.mobility == Mobility::ball) {
    const Quat bend = calc_bend(link, q);
    const Vec3 v = imaginary(bend);
    const double sine = norm(v), sine_most = 0.5 * most;
    if (sine <= sine_most) return;
    const Vec3 kept = v * (sine_most / sine);
    const double cosine = std::sqrt(1 - sine_most * sine_most);
    link.rest_rotation =
        normalized(Quat{cosine, -kept.x, -kept.y, -kept.z} * quat_at(q + link.first_q));
  }
}

int find_stops(const TreeLink& link, const double* q, double margin, JointStop* stops) {
  int count = 0;
  if (is_single(link)) {
    const double x = q[link.first_q];
    if (x - link.lower < margin) stops[count++] = {x - link.lower, {1, 0, 0}};
    if (link.upper - x < margin) stops[count++] = {link.upper - x, {-1, 0, 0}};
  } else if (link.mobility == Mobility::ball && link.upper < kNever) {
    const Quat r = quat_at(q + link.first_q);
    const Vec3 v = imaginary(r) * (r.w < 0 ? -1.0 : 1.0);
    const double sine = norm(v);
    if (sine < 1e-9) return 0;
    // d(2 sin(x / 2)) = cos(x / 2) dx
    const double cosine = std::max(0.05, std::abs(r.w));
    const double gap = 2 * (portable::sin(0.5 * link.upper) - sine) / cosine;
    if (gap < margin) stops[count++] = {gap, {-v.x / sine, -v.y / sine, -v.z / sine}};
  }
  return count;
}

}  // namespace rubble
