// The motions (or displacements) of a tree's links while impulses act on one link after another.
//
// An impulse changes the motion of every link; only those that are asked for are brought up to
// date. One link is in focus: its motion is exact. Going from there to another link passes the
// impulses on towards the meeting of the two and the changes outwards again, so that neighbours
// cost the same in a tree of 200 links as in one of two. settle() brings all up to date.
#pragma once

#include <vector>

#include "kernel/multibody/articulated_inertia.h"

namespace rubble {

class LinkMotions {
 public:
  // All motions, exact. `inertia` must stay as it is until the next call. Impulses count `weight`
  // times.
  void begin(const ArticulatedInertia& inertia, const std::vector<Spatial>& motions,
             double weight = 1);

  const Spatial& focus_on(std::int32_t link);
  // An impulse on the link in focus.
  void apply(const Spatial& impulse) {
    apply(impulse, inertia_->response(focus_) * (impulse * weight_));
  }
  // The same where the change of the link's motion is known.
  void apply(const Spatial& impulse, const Spatial& change) {
    Link& link = links_[std::size_t(focus_)];
    link.motion += change;
    link.impulse.add_scaled(impulse, weight_);
    link.pushed = true;
  }
  void settle();

  // After settle().
  const Spatial& motion(std::int32_t link) const { return links_[std::size_t(link)].motion; }
  void add(const std::vector<Spatial>& changes, double times = 1);
  void scale(double factor);
  int size() const { return int(links_.size()); }

 private:
  struct Link {
    Spatial motion;
    Spatial outer;    // the parent's motion that `motion` goes with
    Spatial impulse;  // since the focus came from the parent, on this link and beyond
    bool pushed = false;
  };
  void go_in();
  void go_out(std::int32_t link);
  void note_outer();

  const ArticulatedInertia* inertia_ = nullptr;
  std::vector<Link> links_;
  std::vector<std::int32_t> way_;
  std::int32_t focus_ = 0;
  double weight_ = 1;
};

}  // namespace rubble
