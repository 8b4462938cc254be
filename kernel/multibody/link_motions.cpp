#include "kernel/multibody/link_motions.h"

namespace rubble {

void LinkMotions::begin(const ArticulatedInertia& inertia, const std::vector<Spatial>& motions,
                        double weight) {
  inertia_ = &inertia;
  weight_ = weight;
  focus_ = 0;
  links_.assign(motions.size(), {});
  for (std::size_t i = 0; i < motions.size(); ++i) links_[i].motion = motions[i];
  note_outer();
}

void LinkMotions::note_outer() {
  for (std::size_t i = 1; i < links_.size(); ++i) {
    links_[i].outer = links_[std::size_t(inertia_->parent(std::int32_t(i)))].motion;
  }
}

void LinkMotions::go_in() {
  Link& from = links_[std::size_t(focus_)];
  const std::int32_t parent = inertia_->parent(focus_);
  Link& to = links_[std::size_t(parent)];
  if (from.pushed) {
    const Spatial impulse = inertia_->inwards(focus_, from.impulse);
    to.motion += inertia_->response(parent) * impulse;
    to.impulse += impulse;
    to.pushed = true;
    from.impulse = {};
    from.pushed = false;
    from.outer = to.motion;
  }
  focus_ = parent;
}

void LinkMotions::go_out(std::int32_t index) {
  const Link& from = links_[std::size_t(inertia_->parent(index))];
  Link& to = links_[std::size_t(index)];
  to.motion += inertia_->outwards(index, from.motion - to.outer);
  to.outer = from.motion;
  focus_ = index;
}

const Spatial& LinkMotions::focus_on(std::int32_t link) {
  way_.clear();
  // A parent's number is smaller than that of its children.
  for (std::int32_t to = link; to != focus_;) {
    if (focus_ > to) {
      go_in();
    } else {
      way_.push_back(to);
      to = inertia_->parent(to);
    }
  }
  for (; !way_.empty(); way_.pop_back()) go_out(way_.back());
  return links_[std::size_t(link)].motion;
}

void LinkMotions::settle() {
  while (focus_ != 0) go_in();
  links_[0].impulse = {};
  links_[0].pushed = false;
  for (std::size_t i = 1; i < links_.size(); ++i) go_out(std::int32_t(i));
  focus_ = 0;
}

void LinkMotions::add(const std::vector<Spatial>& changes, double times) {
  for (std::size_t i = 0; i < links_.size(); ++i) links_[i].motion.add_scaled(changes[i], times);
  note_outer();
}

void LinkMotions::scale(double factor) {
  for (Link& link : links_) link.motion = link.motion * factor;
  note_outer();
}

}  // namespace rubble
