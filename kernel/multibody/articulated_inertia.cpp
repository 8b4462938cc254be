#include "kernel/multibody/articulated_inertia.h"

namespace rubble {
namespace {

SpatialMatrix calc_inertia(const LinkPose& link) {
  SpatialMatrix result;
  for (int i = 0; i < 6; ++i) {
    Vec3 axis;
    axis[i % 3] = 1;
    result.columns[i] = link.momentum(i < 3 ? Spatial{axis, {}} : Spatial{{}, axis});
  }
  return result;
}

// What rounding adds to P - P S D^-1 S^T P that is not symmetric would grow along a chain, tenfold
// with each link; what is symmetric dies out.
void make_symmetric(SpatialMatrix& m) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double mean = 0.5 * (m.columns[i][j] + m.columns[j][i]);
      m.columns[i].pairs[j / 2][j % 2] = mean;
      m.columns[j].pairs[i / 2][i % 2] = mean;
    }
  }
}

// Of a symmetric matrix of up to three rows.
void invert(int count, const double (&m)[3][3], double (&inverse)[3][3]) {
  if (count == 1) {
    inverse[0][0] = 1 / m[0][0];
    return;
  }
  const Vec3 a{m[0][0], m[0][1], m[0][2]}, b{m[1][0], m[1][1], m[1][2]},
      c{m[2][0], m[2][1], m[2][2]};
  const Vec3 rows[3] = {cross(b, c), cross(c, a), cross(a, b)};
  const double scale = 1 / dot(a, rows[0]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) inverse[i][j] = rows[j][i] * scale;
  }
}

}  // namespace

void ArticulatedInertia::set_joint(const SpatialMatrix& inertia, double diagonal,
                                   Link& link) const {
  Spatial moved[3];  // P S
  double d[3][3] = {};
  for (int k = 0; k < link.count; ++k) moved[k] = inertia * link.axes[k];
  for (int i = 0; i < link.count; ++i) {
    for (int j = 0; j < link.count; ++j) d[i][j] = dot(link.axes[i], moved[j]);
    d[i][i] += diagonal;
  }
  if (link.count > 0) invert(link.count, d, link.inverse);
  for (int i = 0; i < link.count; ++i) {
    link.gains[i] = moved[0] * link.inverse[0][i];
    for (int j = 1; j < link.count; ++j) link.gains[i].add_scaled(moved[j], link.inverse[j][i]);
  }
}

void ArticulatedInertia::factor(const Tree& tree, const TreePose& pose,
                                const std::vector<double>& diagonal) {
  const std::size_t count = tree.links.size();
  links_.resize(count);
  inertias_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (pose.links[i].mass > 0) {
      inertias_[i] = calc_inertia(pose.links[i]);
    } else {
      inertias_[i] = {};
    }
  }
  for (std::size_t i = count; i-- > 1;) {
    const TreeLink& from = tree.links[i];
    Link& link = links_[i];
    link.parent = from.parent;
    link.first_u = from.first_u;
    link.count = speed_count(from.mobility);
    for (int k = 0; k < link.count; ++k) {
      link.axes[k] = pose.axes[std::size_t(from.first_u + k)];
    }
    set_joint(inertias_[i], diagonal[i], link);
    SpatialMatrix& carried = inertias_[i];
    Spatial moved[3];
    for (int k = 0; k < link.count; ++k) moved[k] = inertias_[i] * link.axes[k];
    for (int k = 0; k < link.count; ++k) carried.add_product(link.gains[k], moved[k], -1);
    if (link.count > 0) make_symmetric(carried);
    inertias_[std::size_t(from.parent)] += carried;
  }
  Link& root = links_[0];
  root = {};
  root.centre = pose.links[0].centre;
  root.count = speed_count(tree.links[0].mobility);
  if (root.count > 0) root.response = rubble::invert(inertias_[0]);
  for (std::size_t i = 1; i < count; ++i) {
    Link& link = links_[i];
    const SpatialMatrix& outer = links_[std::size_t(link.parent)].response;
    for (int c = 0; c < 6; ++c) {
      Vec3 axis;
      axis[c % 3] = 1;
      const std::int32_t at = std::int32_t(i);
      const Spatial unit = c < 3 ? Spatial{axis, {}} : Spatial{{}, axis};
      Spatial& column = link.response.columns[c];
      column = outwards(at, outer * inwards(at, unit));
      for (int k = 0; k < link.count; ++k) {
        double turn = 0;
        for (int j = 0; j < link.count; ++j) turn += link.inverse[k][j] * link.axes[j][c];
        column.add_scaled(link.axes[k], turn);
      }
    }
  }
}

Spatial ArticulatedInertia::inwards(std::int32_t index, const Spatial& impulse) const {
  const Link& link = links_[std::size_t(index)];
  Spatial result = impulse;
  for (int k = 0; k < link.count; ++k) {
    result.add_scaled(link.gains[k], -dot(link.axes[k], impulse));
  }
  return result;
}

Spatial ArticulatedInertia::outwards(std::int32_t index, const Spatial& change) const {
  const Link& link = links_[std::size_t(index)];
  Spatial result = change;
  for (int k = 0; k < link.count; ++k) {
    result.add_scaled(link.axes[k], -dot(link.gains[k], change));
  }
  return result;
}

SpatialMatrix ArticulatedInertia::calc_cross_response(std::int32_t link, std::int32_t other) const {
  std::int32_t meeting = link, from = other;
  while (meeting != from) {
    std::int32_t& outer = meeting > from ? meeting : from;
    outer = parent(outer);
  }
  std::vector<std::int32_t> way;
  for (std::int32_t i = link; i != meeting; i = parent(i)) way.push_back(i);
  SpatialMatrix result;
  for (int c = 0; c < 6; ++c) {
    Vec3 axis;
    axis[c % 3] = 1;
    Spatial impulse = c < 3 ? Spatial{axis, {}} : Spatial{{}, axis};
    for (std::int32_t i = other; i != meeting; i = parent(i)) impulse = inwards(i, impulse);
    Spatial change = response(meeting) * impulse;
    for (std::size_t i = way.size(); i-- > 0;) change = outwards(way[i], change);
    result.columns[c] = change;
  }
  return result;
}

void ArticulatedInertia::solve(std::vector<Spatial>& impulses,
                               const std::vector<double>& joint_impulses,
                               std::vector<Spatial>& changes) {
  answers_.resize(joint_impulses.size());
  for (std::size_t i = links_.size(); i-- > 1;) {
    const Link& link = links_[i];
    Spatial passed = impulses[i];
    for (int k = 0; k < link.count; ++k) {
      const std::size_t at = std::size_t(link.first_u + k);
      answers_[at] = joint_impulses[at] + dot(link.axes[k], impulses[i]);
    }
    for (int k = 0; k < link.count; ++k) {
      passed.add_scaled(link.gains[k], -answers_[std::size_t(link.first_u + k)]);
    }
    impulses[std::size_t(link.parent)] += passed;
  }
  changes.resize(links_.size());
  Spatial on_root = impulses[0];
  if (links_[0].count > 0) {
    const double* f = joint_impulses.data();
    const Vec3 moment{f[0], f[1], f[2]}, force{f[3], f[4], f[5]};
    on_root += Spatial{moment + cross(links_[0].centre, force), force};
  }
  changes[0] = links_[0].response * on_root;
  for (std::size_t i = 1; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const Spatial& outer = changes[std::size_t(link.parent)];
    changes[i] = outer;
    for (int k = 0; k < link.count; ++k) {
      double speed = -dot(link.gains[k], outer);
      for (int j = 0; j < link.count; ++j) {
        speed += link.inverse[k][j] * answers_[std::size_t(link.first_u + j)];
      }
      changes[i].add_scaled(link.axes[k], speed);
    }
  }
}

}  // namespace rubble
