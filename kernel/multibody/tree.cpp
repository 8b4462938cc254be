#include "kernel/multibody/tree.h"

namespace rubble {

void number_coordinates(Tree& tree) {
  tree.q_count = tree.u_count = 0;
  for (TreeLink& link : tree.links) {
    link.first_q = tree.q_count;
    link.first_u = tree.u_count;
    tree.q_count += coordinate_count(link.mobility);
    tree.u_count += speed_count(link.mobility);
  }
}

void calc_motions(const Tree& tree, const TreePose& pose, const std::vector<double>& u,
                  std::vector<Spatial>& motions) {
  motions.assign(tree.links.size(), {});
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    const double* x = u.data() + link.first_u;
    if (link.parent < 0) {
      if (link.mobility == Mobility::free) {
        const Vec3 w{x[0], x[1], x[2]}, v{x[3], x[4], x[5]};
        motions[i] = {w, v - cross(w, pose.links[i].centre)};
      }
      continue;
    }
    motions[i] = motions[std::size_t(link.parent)];
    for (int k = 0; k < speed_count(link.mobility); ++k) {
      motions[i].add_scaled(pose.axes[std::size_t(link.first_u + k)], x[k]);
    }
  }
}

void calc_speeds(const Tree& tree, const TreePose& pose, const std::vector<Spatial>& motions,
                 std::vector<double>& u) {
  u.resize(std::size_t(tree.u_count));
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    double* x = u.data() + link.first_u;
    if (link.parent < 0) {
      if (link.mobility != Mobility::free) continue;
      const Vec3 w = motions[i].angular(), v = pose.links[i].centre_velocity(motions[i]);
      for (int k = 0; k < 3; ++k) x[k] = w[k], x[3 + k] = v[k];
      continue;
    }
    const int count = speed_count(link.mobility);
    if (count == 0) continue;
    const Spatial relative = motions[i] - motions[std::size_t(link.parent)];
    for (int k = 0; k < count; ++k) {
      x[k] = dot(pose.duals[std::size_t(link.first_u + k)], relative);
    }
  }
}

}  // namespace rubble
