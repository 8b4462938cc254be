#include "app/navigate_ros1/frame_tree.h"

namespace rubble {
namespace {

constexpr int kDeepest = 100;  // a chain that is longer goes in a circle

}  // namespace

FrameTree::Root FrameTree::find_root(const std::string& frame) const {
  Root root{frame, {}};
  for (int depth = 0; depth < kDeepest; ++depth) {
    const auto parent = parents_.find(root.name);
    if (parent == parents_.end()) return root;
    root = {parent->second.name, parent->second.parent_from_child * root.root_from_frame};
  }
  return {"", {}};
}

std::optional<Pose> FrameTree::find(const std::string& to, const std::string& from) const {
  const Root of_to = find_root(to), of_from = find_root(from);
  if (of_to.name.empty() || of_to.name != of_from.name) return {};
  return of_to.root_from_frame.inverse() * of_from.root_from_frame;
}

}  // namespace rubble
