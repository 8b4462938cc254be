// The frames of /tf and /tf_static as they were last heard of.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/live/robot_messages.h"

namespace rubble {

class FrameTree {
 public:
  void add(const HeardTransform& transform) { parents_[transform.child] = {transform.parent, transform.parent_from_child}; }
  // to_from_from: takes coordinates of `from` to `to`; nothing where no chain of frames leads there.
  std::optional<Pose> find(const std::string& to, const std::string& from) const;

 private:
  struct Parent {
    std::string name;
    Pose parent_from_child;
  };
  struct Root {
    std::string name;
    Pose root_from_frame;
  };
  Root find_root(const std::string& frame) const;

  std::map<std::string, Parent> parents_;
};

}  // namespace rubble
