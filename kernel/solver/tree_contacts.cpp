#include "kernel/solver/tree_contacts.h"

#include <algorithm>

#include "kernel/multibody/joints/joint.h"
#include "kernel/solver/contact_law.h"
#include "kernel/solver/contact_solver.h"

namespace rubble {
namespace {

// Of the error of a loop that a step removes.
constexpr double kLoopFraction = 0.5;
// Items of a tree that carries what is heavier than the link under it are solved this often in a substep:
// one sweep lets a slab of 600 kg on the frame of a door tremble for ever.
constexpr int kLoadedSweeps = 8;

void write(const Spatial& motion, PaddedMotion& to) {
  const Vec3f v(motion.linear()), w(motion.angular());
  to.linear = Quad{v.x, v.y, v.z, 0};
  to.angular = Quad{w.x, w.y, w.z, 0};
}

}  // namespace

Spatial TreeContacts::read(const Side& side, const PaddedMotion* free) {
  if (side.number < 0) return {};
  const PaddedMotion& m = free[side.number];
  return {{double(m.angular[0]), double(m.angular[1]), double(m.angular[2])},
          {double(m.linear[0]), double(m.linear[1]), double(m.linear[2])}};
}

void TreeContacts::load(const Item& item, const PaddedMotion* free, bool displacements,
                        View& view) const {
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    view.impulse[s] = {};
    if (side.tree >= 0) {
      TreeMotion& tree = motion(side.tree);
      view.x[s] = (displacements ? tree.moved : tree.speeds).focus_on(side.link);
    } else {
      view.x[s] = read(side, free);
    }
  }
}

// While nothing is pushed, all displacements are up to date.
void TreeContacts::load_moved(const Item& item, const PaddedMotion* free, View& view) const {
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    view.x[s] = side.tree >= 0 ? motion(side.tree).moved.motion(side.link) : read(side, free);
  }
}

void TreeContacts::save(const Item& item, const View& view, bool displacements,
                        PaddedMotion* free) const {
  for (int s = 1; s >= 0; --s) {  // the second side is still in focus
    const Side& side = item.sides[s];
    if (side.tree >= 0) {
      TreeMotion& tree = motion(side.tree);
      LinkMotions& motions = displacements ? tree.moved : tree.speeds;
      const Spatial before = motions.focus_on(side.link);
      if (item.cross >= 0) {
        motions.apply(view.impulse[s]);
      } else {
        motions.apply(view.impulse[s], view.x[s] - before);
      }
    } else if (side.number >= 0) {
      write(view.x[s], free[side.number]);
    }
  }
}

// Returns whether it slides.
template <int sides>
bool TreeContacts::solve_friction(Item& item, double limit, View& view) {
  Row &first = item.slide[0], &second = item.slide[1], &twist = item.twist;
  double v0 = first.relative<sides>(view) + item.belt[0], v1 = second.relative<sides>(view) + item.belt[1];
  double x0 = first.impulse, x1 = second.impulse;
  item.axes.apply(v0, v1);
  item.axes.apply(x0, x1);
  const double masses[3] = {first.mass, second.mass, twist.mass / (item.radius * item.radius)};
  double wanted[3] = {x0 - masses[0] * v0, x1 - masses[1] * v1,
                      (twist.impulse - twist.mass * twist.relative<sides>(view)) / item.radius};
  const contact_law::Slip<double> slip = contact_law::find_slip(limit, masses, wanted);
  for (int t = 0; t < 2; ++t) wanted[t] /= 1 + slip.slide * masses[t];
  const double slide2 = wanted[0] * wanted[0] + wanted[1] * wanted[1];
  const double shrink = contact_law::shrink_into_cone(limit, slide2);
  double slide[2] = {wanted[0] * shrink, wanted[1] * shrink};
  PlaneTurn<double>{item.axes.cosine, -item.axes.sine}.apply(slide[0], slide[1]);
  apply_slide<sides>(item, slide, view);
  // The torque sees what the force has changed.
  const double turned = (twist.impulse - twist.mass * twist.relative<sides>(view)) / (1 + slip.twist * masses[2]);
  const double next = item.radius * contact_law::clamp_twist(limit, slide2 * shrink * shrink, turned / item.radius);
  twist.apply<sides>(next - twist.impulse, view);
  twist.impulse = next;
  return slip.slide > 0;
}

template <int sides>
void TreeContacts::apply_slide(Item& item, const double* slide, View& view) {
  for (int t = 0; t < 2; ++t) {
    item.slide[t].apply<sides>(slide[t] - item.slide[t].impulse, view);
    item.slide[t].impulse = slide[t];
  }
}

// A robot's tracks and wheels: what slides leaves its torque what the force does not use.
template <int sides>
void TreeContacts::solve_driven_friction(Item& item, double limit, View& view) {
  const double v0 = item.slide[0].relative<sides>(view) + item.belt[0],
               v1 = item.slide[1].relative<sides>(view) + item.belt[1];
  const double* inverse = item.slide_inverse;
  const double wanted[2] = {item.slide[0].impulse - inverse[0] * v0 - inverse[1] * v1,
                            item.slide[1].impulse - inverse[1] * v0 - inverse[2] * v1};
  const double length2 = wanted[0] * wanted[0] + wanted[1] * wanted[1];
  const double shrink = contact_law::shrink_into_cone(limit, length2);
  double slide[2] = {wanted[0] * shrink, wanted[1] * shrink};
  if (shrink < 1 && !item.one_way) contact_law::solve_slide(item.slide_matrix, limit, wanted, slide);
  apply_slide<sides>(item, slide, view);
  Row& twist = item.twist;
  const double free = twist.impulse - twist.mass * twist.relative<sides>(view);
  const double slide2 = slide[0] * slide[0] + slide[1] * slide[1];
  const double next = item.radius * contact_law::clamp_twist(limit, slide2, free / item.radius);
  twist.apply<sides>(next - twist.impulse, view);
  twist.impulse = next;
}

template <int sides>
void TreeContacts::solve_normals(Item& item, double per_substep, const View& moved, View& view) {
  // There, back, back and there again, as the sweeps over free pieces.
  const bool backwards = !item.driven && (round_ % 4 == 1 || round_ % 4 == 2);
  for (int k = 0; k < item.rows; ++k) {
    const int i = backwards ? item.rows - 1 - k : k;
    NormalRow& n = rows_[item.first_row + std::size_t(i)];
    const double gap = n.gap + n.row.relative<sides>(moved);
    const double next =
        contact_law::solve_normal(n.row.impulse, n.row.mass, n.row.relative<sides>(view),
                                  contact_law::closing_speed(gap, per_substep));
    n.row.apply<sides>(next - n.row.impulse, view);
    n.row.impulse = next;
  }
}

template <int sides>
void TreeContacts::solve_item(Item& item, double per_substep, const View& moved, View& view) {
  double pressed = sum_impulses(item), limit = 0;
  bool slides = false;
  for (int round = 0; round < kMostRounds; ++round) {
    if (item.driven) {
      solve_driven_friction<sides>(item, item.friction * pressed, view);
    } else if (item.kind == Kind::contact) {
      limit = std::max(0.0, item.friction * pressed + item.owed);
      slides = solve_friction<sides>(item, limit, view);
    }
    solve_normals<sides>(item, per_substep, moved, view);
    const double before = pressed;
    pressed = sum_impulses(item);
    if (item.kind == Kind::stop || pressed <= before + before * double(kImpactRise)) break;
  }
  item.owed = slides ? item.owed + item.friction * pressed - limit : 0;
}

void TreeContacts::solve_loop(Item& item, View& view) {
  for (int i = 0; i < item.rows; ++i) {
    Row& row = rows_[item.first_row + std::size_t(i)].row;
    const double change = -row.mass * row.relative<2>(view);
    row.apply<2>(change, view);
    row.impulse += change;
  }
}

// Coulomb's law for the speeds of a joint: no more than a torque, or force, that is given.
void TreeContacts::solve_dry(Item& item, View& view) {
  double wanted[3] = {}, length2 = 0;
  for (int i = 0; i < item.rows; ++i) {
    const Row& row = rows_[item.first_row + std::size_t(i)].row;
    wanted[i] = row.impulse - row.mass * row.relative<2>(view);
    length2 += wanted[i] * wanted[i];
  }
  const double shrink = contact_law::shrink_into_cone(item.friction, length2);
  for (int i = 0; i < item.rows; ++i) {
    Row& row = rows_[item.first_row + std::size_t(i)].row;
    row.apply<2>(wanted[i] * shrink - row.impulse, view);
    row.impulse = wanted[i] * shrink;
  }
}

double TreeContacts::sum_impulses(const Item& item) const {
  double sum = 0;
  for (int i = 0; i < item.rows; ++i) sum += rows_[item.first_row + std::size_t(i)].row.impulse;
  return sum;
}

// The totals are kept for the loads of joints.
void TreeContacts::clamp_accumulated_impulses(Item& item, double weight) {
  double carried = 0;
  for (int i = 0; i < item.rows; ++i) {
    NormalRow& n = rows_[item.first_row + std::size_t(i)];
    n.row.total += n.row.impulse;
    if (item.kind != Kind::contact && item.kind != Kind::stop) continue;
    n.row.impulse = contact_law::clamp_accumulated_impulses(n.row.impulse, n.carried, n.row.mass, weight);
    n.carried = n.row.impulse;
    carried += n.row.impulse;
  }
  if (item.kind != Kind::contact) return;
  Row &first = item.slide[0], &second = item.slide[1];
  const double limit = item.friction * carried, torque = item.twist.impulse / item.radius;
  const double slide2 = first.impulse * first.impulse + second.impulse * second.impulse;
  const double shrink = contact_law::shrink_into_cone(limit, slide2 + (item.driven ? 0 : torque * torque));
  first.impulse *= shrink;
  second.impulse *= shrink;
  item.twist.impulse =
      item.driven ? item.radius * contact_law::clamp_twist(limit, 0.0, torque) : item.twist.impulse * shrink;
}

// The impulse that a substep ended with, on each side that may break.
void TreeContacts::note_total(Item& item) {
  bool any = false;
  for (const Side& side : item.sides) {
    any = any || (side.tree >= 0 && motion(side.tree).feels_loads());
  }
  if (!any || (item.kind != Kind::contact && item.kind != Kind::loop)) return;
  const auto add = [&](const Row& row) {
    for (int s = 0; s < 2; ++s) item.total[s].add_scaled(row.jacobian[s], row.impulse);
  };
  for (int i = 0; i < item.rows; ++i) add(rows_[item.first_row + std::size_t(i)].row);
  if (item.kind != Kind::contact) return;
  for (const Row* row : {&item.slide[0], &item.slide[1], &item.twist}) add(*row);
}

// Hands the impulses that the item starts with to its sides.
void TreeContacts::start(const Item& item, PaddedMotion* speeds) const {
  View view;
  for (int s = 0; s < 2; ++s) {
    view.impulse[s] = {};
    view.x[s] = read(item.sides[s], speeds);
  }
  const auto apply = [&](const Row& row) {
    for (int s = 0; s < item.moving; ++s) {
      if (item.sides[s].tree >= 0) {
        view.impulse[s].add_scaled(row.jacobian[s], row.impulse);
      } else {
        view.x[s].add_scaled(row.response[s], row.impulse);
      }
    }
  };
  for (int i = 0; i < item.rows; ++i) apply(rows_[item.first_row + std::size_t(i)].row);
  if (item.kind == Kind::contact) {
    for (const Row* row : {&item.slide[0], &item.slide[1], &item.twist}) apply(*row);
  }
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    if (side.tree >= 0) {
      motion(side.tree).push(side.link, view.impulse[s]);
    } else if (side.number >= 0) {
      write(view.x[s], speeds[side.number]);
    }
  }
}

void TreeContacts::begin_substep(PaddedMotion* speeds, bool first, double weight) {
  round_ = first ? 0 : round_ + 1;
  for (std::int32_t index : sequence_) {
    Item& item = items_[std::size_t(index)];
    if (!first) note_total(item), clamp_accumulated_impulses(item, weight);
    if (item.kind == Kind::contact && (first || item.driven)) place_friction(item);
    start(item, speeds);
  }
  for (std::int32_t tree : trees_.trees) motion(tree).add_forces();
}

void TreeContacts::solve_one(Item& item, double per_substep, const PaddedMotion* moved,
                             PaddedMotion* speeds) {
  View view, displaced;
  load(item, speeds, false, view);
  if (item.kind == Kind::loop) {
    solve_loop(item, view);
  } else if (item.kind == Kind::dry) {
    solve_dry(item, view);
  } else if (item.kind == Kind::motor) {
    solve_motor(item, view);
  } else {
    load_moved(item, moved, displaced);
    if (item.moving == 1) {
      solve_item<1>(item, per_substep, displaced, view);
    } else {
      solve_item<2>(item, per_substep, displaced, view);
    }
  }
  save(item, view, false, speeds);
}

void TreeContacts::solve_velocities(double per_substep, const PaddedMotion* moved,
                                    PaddedMotion* speeds) {
  for (int sweep = 0; sweep < kLoadedSweeps; ++sweep) {
    for (std::int32_t index : sequence_) {
      Item& item = items_[std::size_t(index)];
      if (sweep == 0 || item.loaded) solve_one(item, per_substep, moved, speeds);
    }
  }
}

void TreeContacts::end_substep() {
  for (std::int32_t tree : trees_.trees) motion(tree).move();
}

void TreeContacts::end_substeps(double weight) {
  for (Item& item : items_) note_total(item), clamp_accumulated_impulses(item, weight);
}

bool TreeContacts::begin_pushes(const SolverSettings& settings, const PaddedMotion* moved) {
  for (std::int32_t tree : trees_.trees) motion(tree).begin_pushes();
  bool any = false;
  const double full = double(settings.maximum_push), faded = full * (1 - double(settings.fading));
  for (std::int32_t index : sequence_) {
    const Item& item = items_[std::size_t(index)];
    if (item.kind == Kind::dry || item.kind == Kind::motor) continue;
    View view;
    load(item, moved, true, view);
    for (int i = 0; i < item.rows; ++i) {
      NormalRow& n = rows_[item.first_row + std::size_t(i)];
      const double done = n.row.relative<2>(view);
      const double gap = n.gap + done;
      double wanted = 0;
      if (item.kind == Kind::loop) {
        wanted = std::clamp(-gap * kLoopFraction, -faded, faded);
      } else {
        const double left = gap + double(settings.slop);
        const double most = left < -double(settings.deep) ? full : faded;
        wanted = left < 0 ? std::min(-left * double(settings.position_fraction), most) : -left;
      }
      n.push_target = done + wanted;
      any = any || wanted > 0 || (item.kind == Kind::loop && wanted != 0);
    }
  }
  return any;
}

void TreeContacts::solve_pushes(PaddedMotion* moved) {
  for (std::int32_t index : sequence_) {
    Item& item = items_[std::size_t(index)];
    if (item.kind == Kind::dry || item.kind == Kind::motor) continue;
    View view;
    load(item, moved, true, view);
    for (int i = 0; i < item.rows; ++i) {
      NormalRow& n = rows_[item.first_row + std::size_t(i)];
      double next = n.push + n.push_mass * (n.push_target - n.row.relative<2>(view));
      if (item.kind != Kind::loop) next = std::max(0.0, next);
      for (int s = 0; s < 2; ++s) {
        const double change = next - n.push;
        view.x[s].add_scaled(n.row.response[s], change * item.sides[s].push_weight);
        view.impulse[s].add_scaled(n.row.jacobian[s], change);
      }
      n.push = next;
    }
    save(item, view, true, moved);
  }
}

void TreeContacts::store_loop(const Item& item) {
  TreeMotion& tree = motion(item.sides[0].tree);
  TreeLoop& loop = tree.tree().loops[std::size_t(item.source)];
  const Joint& joint = joint_of(loop.mobility);
  std::size_t at = item.first_row;
  Vec3 force, torque;
  for (int axis = 0; axis < 3; ++axis) {
    if (!joint.holds_travel(axis)) continue;
    loop.force_impulse[axis] = rows_[at].row.impulse;
    force[axis] = rows_[at++].row.total;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!joint.holds_turn(axis)) continue;
    loop.torque_impulse[axis] = rows_[at].row.impulse;
    torque[axis] = rows_[at++].row.total;
  }
  loop.broken = norm(force) > loop.break_force * tree.step() ||
                norm(torque) > loop.break_torque * tree.step();
}

bool TreeContacts::acts(const Item& item) const {
  for (int i = 0; i < item.rows; ++i) {
    const NormalRow& n = rows_[item.first_row + std::size_t(i)];
    if (n.row.total != 0 || n.push != 0) return true;
    if (item.kind == Kind::loop || item.kind == Kind::motor) return true;
  }
  return false;
}

void TreeContacts::store(const std::vector<Body>&, std::vector<Contact>& contacts) {
  for (const Item& item : items_) {
    for (int s = 0; s < 2; ++s) {
      if (item.sides[s].tree < 0) continue;
      TreeMotion& tree = motion(item.sides[s].tree);
      tree.note_impulse(item.sides[s].link, item.total[s], item.kind == Kind::contact);
      tree.impelled = tree.impelled || acts(item);
    }
    if (item.kind == Kind::loop) store_loop(item);
    if (item.kind == Kind::dry) {
      Vec3& kept = motion(item.sides[0].tree).tree().links[std::size_t(item.source)].friction_impulse;
      for (int i = 0; i < item.rows; ++i) {
        kept[i] = rows_[item.first_row + std::size_t(i)].row.impulse;
      }
    }
    if (item.kind == Kind::motor) store_motor(item);
    if (item.kind != Kind::contact) continue;
    Contact& contact = contacts[std::size_t(item.source)];
    double pressed = 0;
    for (int i = 0; i < item.rows; ++i) {
      const Row& row = rows_[item.first_row + std::size_t(i)].row;
      contact.points[i].normal_impulse = float(row.impulse);
      pressed += row.total;
    }
    contact.friction_impulse = Vec3f(item.tangents[0] * item.slide[0].impulse +
                                     item.tangents[1] * item.slide[1].impulse);
    contact.twist_impulse = float(item.twist.impulse);
    contact.pressed = float(pressed);
  }
}

}  // namespace rubble
