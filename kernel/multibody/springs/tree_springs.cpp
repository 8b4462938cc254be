#include "kernel/multibody/springs/tree_springs.h"

#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/multibody/joints/joint.h"
#include "kernel/multibody/tree_motion.h"

namespace rubble {
namespace {

constexpr int kBisections = 50;  // halvings of the arc of taut wall: to its last bits; unit: 1

// Half the arc of taut wall, e in (0, pi]: the wall's tension balances the pressure where
// sin e - e cos e = pi / bend, which rises with e.
double find_taut_arc(double bend) {
  double low = 0, high = portable::kPi;
  for (int i = 0; i < kBisections; ++i) {
    const double e = 0.5 * (low + high);
    const auto [s, c] = portable::sincos(e);
    (s - e * c < portable::kPi / bend ? low : high) = e;
  }
  return 0.5 * (low + high);
}

}  // namespace

InflatedBend calc_inflated_bend(double bend) {
  if (bend <= 1) return {bend, 1, 0.5 * bend * bend};
  const double e = find_taut_arc(bend);
  const auto [s, c] = portable::sincos(e);
  InflatedBend result;
  result.moment = (e - s * c) / (s - e * c);
  result.tangent = (e + s * c - 2 * s * s / e) / portable::kPi;
  const double squares = e * (c * c + 0.5) - 1.5 * s * c;  // integral of the squared strains
  result.energy = 1 + bend * bend * squares / portable::kPi + 2 * bend * c;
  return result;
}

double calc_section_bend(const Tree& tree, const TreeLink& link, const std::vector<double>& q) {
  double x = q[std::size_t(link.first_q)] - link.rest, y = 0;
  if (link.wrinkles_with >= 0) {
    const TreeLink& other = tree.links[std::size_t(link.wrinkles_with)];
    y = q[std::size_t(other.first_q)] - other.rest;
  }
  return std::sqrt(x * x + y * y) * link.stiffness / link.wrinkling;
}

void TreeMotion::add_spring(std::size_t index, double* forces) const {
  const TreeLink& link = tree_->links[index];
  if (link.wrinkling == kNever) {
    joint_of(link.mobility).add_spring(link, state_.q.data() + link.first_q, forces);
    return;
  }
  const double bend = calc_section_bend(*tree_, link, state_.q);
  const double share = bend > 1 ? calc_inflated_bend(bend).moment / bend : 1;
  forces[0] -= share * link.stiffness * (state_.q[std::size_t(link.first_q)] - link.rest);
}

// Of a wrinkled section: the tangent along the bend, the secant across it. What is slack does not damp.
void TreeMotion::set_diagonal(double time, double span) {
  diagonal_.assign(tree_->links.size(), 0);
  resistance_.assign(tree_->links.size(), 0);
  for (std::size_t i = 1; has_springs_ && i < tree_->links.size(); ++i) {
    const TreeLink& link = tree_->links[i];
    const double* q = state_.q.data() + link.first_q;
    double tangent =
        joint_of(link.mobility).calc_tangent_stiffness(link, q, state_.u.data() + link.first_u);
    double damping = link.damping;
    const double bend = link.wrinkling == kNever ? 0 : calc_section_bend(*tree_, link, state_.q);
    if (bend > 1) {
      const InflatedBend law = calc_inflated_bend(bend);
      const double x = (q[0] - link.rest) * link.stiffness / link.wrinkling / bend, along = x * x;
      const double share = law.tangent * along + law.moment / bend * (1 - along);
      tangent *= share;
      damping *= share;
    }
    resistance_[i] = damping + span * tangent;
    diagonal_[i] = time * resistance_[i];
  }
}

double calc_spring_energy(const Tree& tree, const std::vector<double>& q) {
  double sum = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (link.parent < 0) continue;
    if (link.wrinkling == kNever) {
      sum += joint_of(link.mobility).calc_spring_energy(link, q.data() + link.first_q);
    } else if (link.wrinkles_with < std::int32_t(i)) {  // once for both hinges of a section
      const double bend = calc_section_bend(tree, link, q);
      sum += calc_inflated_bend(bend).energy * link.wrinkling * link.wrinkling / link.stiffness;
    }
  }
  return sum;
}

}  // namespace rubble
