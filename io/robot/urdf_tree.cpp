#include "io/robot/urdf_elements.h"

#include <algorithm>
#include <map>
#include <utility>

namespace rubble {
namespace {

// Puts links and joints into the order of a tree.
class TreeOrder {
 public:
  TreeOrder(UrdfElements& elements, std::vector<UrdfLink> links, std::vector<UrdfNamedJoint> joints)
      : elements_(elements), links_(std::move(links)), joints_(std::move(joints)) {}

  void order(UrdfFile& file) {
    number_links();
    find_children();
    elements_.throw_mistakes();
    std::size_t root = find_root();
    elements_.throw_mistakes();
    root = release_root(root);
    file.fixed = links_[root].name == "world";
    take(root, file);
    if (file.links.size() + left_out_ != links_.size()) refuse_loops();
    elements_.throw_mistakes();
  }

 private:
  void number_links() {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      elements_.set_owner(links_[i].name);
      if (!numbers_.emplace(links_[i].name, i).second)
        elements_.mistake(links_[i].line, "two links have this name", "a name of its own",
                          "another in line " + std::to_string(links_[numbers_[links_[i].name]].line));
    }
    std::map<std::string, int> lines;
    for (const UrdfNamedJoint& joint : joints_) {
      elements_.set_owner(joint.joint.name);
      const auto [at, is_new] = lines.emplace(joint.joint.name, joint.joint.line);
      if (!is_new)
        elements_.mistake(joint.joint.line, "two joints have this name", "a name of its own",
                          "another in line " + std::to_string(at->second));
    }
  }

  void find_children() {
    children_.resize(links_.size());
    parent_joint_.assign(links_.size(), -1);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      elements_.set_owner(joints_[j].joint.name);
      const auto parent = numbers_.find(joints_[j].parent), child = numbers_.find(joints_[j].child);
      for (const auto& [end, name] : {std::make_pair(parent, &joints_[j].parent), std::make_pair(child, &joints_[j].child)})
        if (end == numbers_.end())
          elements_.mistake(joints_[j].joint.line, "the file has no link of this name", "a link of the file",
                            "\"" + *name + "\"");
      if (parent == numbers_.end() || child == numbers_.end()) continue;
      int& by = parent_joint_[child->second];
      if (by >= 0) {
        elements_.mistake(joints_[j].joint.line,
                          "closes a loop: link `" + joints_[j].child + "` hangs on another joint already",
                          "a tree: each link is the child of one joint", "`" + joints_[std::size_t(by)].joint.name + "`");
        continue;
      }
      by = int(j);
      children_[parent->second].push_back(j);
    }
    // As liburdfdom and pinocchio order them.
    for (std::vector<std::size_t>& joints : children_)
      std::sort(joints.begin(), joints.end(),
                [this](std::size_t a, std::size_t b) { return joints_[a].joint.name < joints_[b].joint.name; });
  }

  std::size_t find_root() {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (parent_joint_[i] < 0) roots.push_back(i);
    elements_.set_owner("");
    if (links_.empty()) elements_.mistake(0, "the robot has no link", "one or more", "none");
    if (!links_.empty() && roots.empty())
      elements_.mistake(0, "no root: every link hangs on another", "one link that is the child of no joint", "none");
    for (std::size_t i = 1; i < roots.size(); ++i) {
      elements_.set_owner(links_[roots[i]].name);
      elements_.mistake(links_[roots[i]].line, "hangs on nothing that leads to the root", "one tree of links",
                        "a second root beside `" + links_[roots[0]].name + "`");
    }
    return roots.empty() ? 0 : roots[0];
  }

  // A root without mass and shape that carries one floating joint stands for the world: the robot begins below it.
  std::size_t release_root(std::size_t root) {
    const UrdfLink& link = links_[root];
    const bool empty = !link.has_inertial && link.collisions.empty() && link.visuals.empty();
    if (!empty || children_[root].size() != 1 || !joints_[children_[root][0]].floating) return root;
    const UrdfNamedJoint& joint = joints_[children_[root][0]];
    elements_.warn(joint.joint.line, "the link `" + link.name + "` and the floating joint `" + joint.joint.name +
                                         "` are left out: the robot moves freely, from its `position` on");
    left_out_ = 1;
    const std::size_t below = numbers_.at(joint.child);
    parent_joint_[below] = -1;
    return below;
  }

  void take(std::size_t root, UrdfFile& file) {
    struct Step {
      std::size_t link;
      int parent;
    };
    std::vector<Step> open{{root, -1}};
    while (!open.empty()) {
      const Step step = open.back();
      open.pop_back();
      const int number = int(file.links.size());
      if (step.parent >= 0) add_joint(joints_[std::size_t(parent_joint_[step.link])], step.parent, number, file);
      file.links.push_back(links_[step.link]);
      const std::vector<std::size_t>& joints = children_[step.link];
      for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint)
        open.push_back({numbers_.at(joints_[*joint].child), number});
    }
  }

  void add_joint(const UrdfNamedJoint& named, int parent, int child, UrdfFile& file) {
    UrdfJoint joint = named.joint;
    joint.parent = parent, joint.child = child;
    elements_.set_owner(joint.name);
    if (named.floating)
      elements_.mistake(joint.line, "this type of joint is not supported here",
                        "fixed, revolute, continuous or prismatic; floating below a root without mass and shape alone",
                        "\"floating\"");
    file.joints.push_back(joint);
  }

  void refuse_loops() {
    elements_.set_owner("");
    elements_.mistake(0, "some links form a loop that no joint ties to the root", "one tree of links", "a loop");
  }

  UrdfElements& elements_;
  std::vector<UrdfLink> links_;
  std::vector<UrdfNamedJoint> joints_;
  std::map<std::string, std::size_t> numbers_;      // of the links
  std::vector<std::vector<std::size_t>> children_;  // by link: joints
  std::vector<int> parent_joint_;                   // by link; -1: none
  std::size_t left_out_ = 0;                        // links above the root
};

}  // namespace

void order_urdf_tree(UrdfElements& elements, std::vector<UrdfLink> links, std::vector<UrdfNamedJoint> joints, UrdfFile& file) {
  TreeOrder(elements, std::move(links), std::move(joints)).order(file);
}

}  // namespace rubble
