// Joints that break: the tree falls into smaller ones and free pieces.
#include <algorithm>

#include "kernel/world/phases/trees.h"

namespace rubble {
namespace {

// Links of an old tree that stay together, the first of them as root.
struct Fragment {
  std::vector<std::int32_t> links;
};

std::vector<Fragment> find_fragments(const Tree& tree, const std::vector<std::uint8_t>& broken) {
  std::vector<Fragment> fragments;
  std::vector<std::size_t> fragment_of;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const std::int32_t parent = tree.links[i].parent;
    if (parent < 0 || broken[i]) {
      fragment_of.push_back(fragments.size());
      fragments.emplace_back();
    } else {
      fragment_of.push_back(fragment_of[std::size_t(parent)]);
    }
    fragments[fragment_of.back()].links.push_back(std::int32_t(i));
  }
  return fragments;
}

// A fragment as a tree of its own, at the same coordinates and speeds.
Tree cut_out(const Tree& from, const TreeState& state, const Fragment& fragment,
             const std::vector<Body>& bodies, TreeState& cut) {
  Tree tree;
  for (std::int32_t i : fragment.links) {
    TreeLink link = from.links[std::size_t(i)];
    const auto at = std::find(fragment.links.begin(), fragment.links.end(), link.parent);
    if (at != fragment.links.end()) {
      link.parent = std::int32_t(at - fragment.links.begin());
    } else if (link.mobility != Mobility::fixed) {
      TreeLink root;  // its joint is gone
      root.body = link.body;
      root.linear = link.linear;
      root.angular = link.angular;
      link = root;
    }
    tree.mass += bodies[std::size_t(link.body)].mass;
    tree.links.push_back(link);
  }
  // A loop between two fragments opens with the tree.
  for (TreeLoop loop : from.loops) {
    const auto place = [&](std::int32_t& link) {
      const auto at = std::find(fragment.links.begin(), fragment.links.end(), link);
      link = std::int32_t(at - fragment.links.begin());
      return at != fragment.links.end();
    };
    const bool a = place(loop.link_a), b = place(loop.link_b);
    if (a && b) tree.loops.push_back(loop);
  }
  tree.root = bodies[std::size_t(tree.links[0].body)].world_from_com;
  number_coordinates(tree);
  cut.q.assign(std::size_t(tree.q_count), 0);
  cut.u.assign(std::size_t(tree.u_count), 0);
  for (std::size_t k = 0; k < tree.links.size(); ++k) {
    const TreeLink& link = tree.links[k];
    if (link.mobility == Mobility::free) {
      const Quat& r = tree.root.rotation;
      const Vec3 &p = tree.root.translation, &w = link.angular, &v = link.linear;
      const double q[7] = {r.w, r.x, r.y, r.z, p.x, p.y, p.z};
      const double u[6] = {w.x, w.y, w.z, v.x, v.y, v.z};
      std::copy(q, q + 7, cut.q.begin());
      std::copy(u, u + 6, cut.u.begin());
      continue;
    }
    const TreeLink& old = from.links[std::size_t(fragment.links[k])];
    std::copy_n(state.q.begin() + old.first_q, coordinate_count(link.mobility), cut.q.begin() + link.first_q);
    std::copy_n(state.u.begin() + old.first_u, speed_count(link.mobility), cut.u.begin() + link.first_u);
  }
  return tree;
}

}  // namespace

void WorldTrees::break_joints(Pairs& pairs) {
  released_.clear();
  for (std::int32_t tree : awake_) {
    const std::vector<Spatial>& loads = motions_[tree].loads();
    const std::vector<TreeLink>& links = data_.trees[tree].links;
    std::vector<std::uint8_t> broken(links.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      if (links[i].parent < 0) continue;
      broken[i] =
          norm(loads[i].linear()) > links[i].break_force || norm(loads[i].angular()) > links[i].break_torque;
      any = any || broken[i];
    }
    open_loops(tree);
    if (any) split(tree, broken);
  }
  for (const std::int32_t body : released_) pairs.find_first(body);
}

// Joints that closed a loop and broke: the tree stays as it is.
void WorldTrees::open_loops(int index) {
  Tree& tree = data_.trees[index];
  for (std::size_t i = 0; i < tree.loops.size();) {
    const TreeLoop& loop = tree.loops[i];
    if (!loop.broken) {
      ++i;
      continue;
    }
    released_.push_back(tree.links[std::size_t(loop.link_a)].body);
    tree.loops.erase(tree.loops.begin() + std::ptrdiff_t(i));
  }
}

void WorldTrees::split(int index, const std::vector<std::uint8_t>& broken) {
  const Tree old = data_.trees[index];
  const TreeState state = simbody_.state(index);
  for (std::size_t i = 0; i < old.links.size(); ++i) {
    if (broken[i]) released_.push_back(old.links[i].body);
  }
  replace(index, {}, {});
  for (const Fragment& fragment : find_fragments(old, broken)) {
    if (fragment.links.size() == 1) {
      release(old.links[std::size_t(fragment.links[0])]);
      continue;
    }
    TreeState cut;
    const Tree tree = cut_out(old, state, fragment, data_.bodies, cut);
    int number = index;
    if (data_.trees[index].links.empty()) {
      replace(index, tree, cut);
    } else {
      number = simbody_.add(tree, data_.bodies, cut);
      data_.trees.push_back(tree);
    }
    for (std::size_t k = 0; k < tree.links.size(); ++k) {
      data_.bodies[tree.links[k].body].tree = number;
      data_.bodies[tree.links[k].body].link = std::int32_t(k);
    }
  }
}

// A link that is left alone goes on as an ordinary piece.
void WorldTrees::release(const TreeLink& link) {
  Body& body = data_.bodies[link.body];
  body.tree = body.link = -1;
  if (body.mass == 0) return;
  body.free_index = blocks_.add({{body.mass, body.inertia, body.world_from_com, link.linear, link.angular}});
}

}  // namespace rubble
