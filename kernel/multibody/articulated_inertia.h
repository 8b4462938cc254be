// Response of a tree to impulses: M^-1 in time proportional to the number of links, where M is the mass matrix plus a
// diagonal of the joints (articulated bodies; Featherstone 2008, chapter 7).
//
// Simbody's multiplyByMInv() gives the same result if the diagonal is zero. But it cannot include the diagonal of
// implicit springs, and it computes the response of all links at once. The contact solver needs single links, many times
// a step. So the factors are computed here, from the hinge matrices and spatial inertias of Simbody (TreePose).
#pragma once

#include <vector>

#include "kernel/multibody/tree.h"

namespace rubble {

class ArticulatedInertia {
 public:
  // diagonal: by link, added to M for each speed of its joint.
  void factor(const Tree& tree, const TreePose& pose, const std::vector<double>& diagonal);

  // Change of a link's motion by a unit impulse on it, as a matrix: J M^-1 J^T.
  const SpatialMatrix& response(std::int32_t link) const {
    return links_[std::size_t(link)].response;
  }
  // The same of `link` by an impulse on `other`.
  SpatialMatrix calc_cross_response(std::int32_t link, std::int32_t other) const;

  // What an impulse on a link is to its parent, and what a change of the parent's motion is to the
  // link, where nothing else acts on the link and what hangs on it.
  Spatial inwards(std::int32_t index, const Spatial& impulse) const {
    const Link& link = links_[std::size_t(index)];
    Spatial result = impulse;
    for (int k = 0; k < link.count; ++k) {
      result.add_scaled(link.gains[k], -dot(link.axes[k], impulse));
    }
    return result;
  }
  Spatial outwards(std::int32_t index, const Spatial& change) const {
    const Link& link = links_[std::size_t(index)];
    Spatial result = change;
    for (int k = 0; k < link.count; ++k) {
      result.add_scaled(link.axes[k], -dot(link.gains[k], change));
    }
    return result;
  }

  // Changes of all motions by impulses on links (which are used up) and on joints (by speed; of a
  // free root's speeds: moment about its centre of mass and force).
  void solve(std::vector<Spatial>& impulses, const std::vector<double>& joint_impulses,
             std::vector<Spatial>& changes);
  std::int32_t parent(std::int32_t link) const { return links_[std::size_t(link)].parent; }
  int size() const { return int(links_.size()); }

 private:
  struct Link {
    std::int32_t parent = -1, first_u = 0, count = 0;
    Vec3 centre;        // of a free root
    Spatial axes[3];    // S
    Spatial gains[3];   // P S D^-1
    double inverse[3][3] = {};  // D^-1, D = S^T P S and the diagonal
    SpatialMatrix response;
  };
  void set_joint(const SpatialMatrix& inertia, double diagonal, Link& link) const;

  std::vector<Link> links_;
  std::vector<SpatialMatrix> inertias_;
  std::vector<double> answers_;
};

}  // namespace rubble
