#include "kernel/solver/contact_solver.h"

#include <algorithm>
#include <cmath>


namespace rubble {
namespace {

// Inertia of a carrying piece against what it carries, see share_inertia().
constexpr double kMassRatio = 5;
constexpr float kAbove = 0.2F;       // the normal's rise from which a piece counts as carrying
constexpr float kCarrySpeed = 0.5F;  // unit: m/s
// Below these, speeds that pushes undo are dropped.
constexpr float kSlowSpeed = 0.2F;  // unit: m/s
constexpr float kSlowSpin = 2.0F;   // unit: rad/s

PaddedMotion padded(const Motion& m) {
  return {Quad{m.linear.x, m.linear.y, m.linear.z, 0},
          Quad{m.angular.x, m.angular.y, m.angular.z, 0}};
}
Motion unpadded(const PaddedMotion& m) {
  return {{m.linear[0], m.linear[1], m.linear[2]}, {m.angular[0], m.angular[1], m.angular[2]}};
}

}  // namespace

// Contacts with an awake link of a tree are solved after the others in each sweep.
void ContactSolver::note_heads(const std::vector<Body>& bodies,
                               const std::vector<std::int32_t>& order,
                               const std::vector<Contact>& contacts, const SolvedTrees& trees,
                               ThreadPool& pool) {
  const bool any_trees = !trees.trees.empty();
  const auto is_link = [&bodies](std::int32_t body) {
    return body != kGround && bodies[body].awake && bodies[body].tree >= 0;
  };
  heads_.resize(order.size());
  pool.run(int(order.size()), 128, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Contact& contact = contacts[order[i]];
      heads_[i] = {order[i], contact.body_a, contact.body_b, contact.count, contact.normal.z,
                   any_trees && (is_link(contact.body_a) || is_link(contact.body_b))};
    }
  });
  tree_order_.clear();
  if (!any_trees) return;
  for (const Head& head : heads_) {
    if (head.tree) tree_order_.push_back(head.contact);
  }
}

void ContactSolver::number_bodies(const std::vector<Body>& bodies) {
  constexpr std::int32_t kUnseen = -1, kStays = -2;
  number_.assign(bodies.size(), kUnseen);
  for (const Head& head : heads_) {
    for (std::int32_t body : {head.body_a, head.body_b}) {
      if (body == kGround || number_[body] != kUnseen) continue;
      number_[body] = bodies[body].awake && bodies[body].tree < 0 ? 0 : kStays;
    }
  }
  moving_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (number_[i] < 0) continue;
    number_[i] = std::int32_t(moving_.size());
    moving_.push_back(std::int32_t(i));
  }
  for (std::int32_t& n : number_) n = n < 0 ? std::int32_t(moving_.size()) : n;
}

// A light piece under a heavy one carries a load of many times its weight, which the sweeps reach
// only after as many rounds, and in the meantime the heavy one bounces on it. While it is slow, its
// inertia (not its weight) counts as at least 1/kMassRatio of what lies on it: loads at rest stay
// exact, and momentum that goes into the light piece is lost, never gained. What nothing holds up from
// below carries nothing: where two meet in the air, momentum is kept.
void ContactSolver::share_inertia(const std::vector<Body>& bodies) {
  share_.assign(moving_.size() + 1, 1.0F);
  held_.assign(moving_.size() + 1, 0);
  for (const Head& head : heads_) {
    if (head.up < -kAbove) held_[number_[head.body_a]] = 1;
    if (head.body_b != kGround && head.up > kAbove) held_[number_[head.body_b]] = 1;
  }
  const auto carry = [&](std::int32_t light, std::int32_t heavy, float up) {
    if (up < kAbove || number_[light] == std::int32_t(moving_.size())) return;
    const Body &l = bodies[light], &h = bodies[heavy];
    if (held_[number_[light]] == 0 || !h.awake) return;
    if (dot(l.linear, l.linear) > kCarrySpeed * kCarrySpeed) return;
    const float share = float(kMassRatio * l.mass / h.mass);
    share_[number_[light]] = std::min(share_[number_[light]], share);
  };
  for (const Head& head : heads_) {
    if (head.body_b == kGround) continue;
    carry(head.body_a, head.body_b, head.up);
    carry(head.body_b, head.body_a, -head.up);
  }
}

// The first batch later than `after` with room for a contact of so many rows.
int ContactSolver::find_batch(int rows, int after) {
  std::vector<std::int32_t>& open = open_[rows];
  for (std::size_t i = 0; i < open.size(); ++i) {
    const int batch = open[i];
    if (batch <= after) continue;
    if (++lanes_used_[batch] == kLanes) open.erase(open.begin() + std::ptrdiff_t(i));
    return batch;
  }
  ContactBatch batch{};
  batch.first_row = row_count_;
  batch.rows = rows;
  for (int lane = 0; lane < kLanes; ++lane) {
    batch.a[lane] = batch.b[lane] = std::int32_t(moving_.size());
    batch.contact[lane] = -1;
  }
  row_count_ += rows;
  open.push_back(std::int32_t(batches_.size()));
  lanes_used_.push_back(1);
  batches_.push_back(batch);
  return int(batches_.size()) - 1;
}

void ContactSolver::pack() {
  batches_.clear();
  row_count_ = 0;
  lanes_used_.clear();
  for (auto& open : open_) open.clear();
  last_batch_.assign(moving_.size() + 1, -1);
  const int beyond = int(moving_.size());
  for (const Head& head : heads_) {
    if (head.tree) continue;
    const int a = number_[head.body_a];
    const int b = head.body_b == kGround ? beyond : number_[head.body_b];
    last_batch_[beyond] = -1;
    const int found = find_batch(head.count, std::max(last_batch_[a], last_batch_[b]));
    last_batch_[a] = last_batch_[b] = found;
    ContactBatch& batch = batches_[found];
    const int lane = lanes_used_[found] - 1;
    batch.a[lane] = a;
    batch.b[lane] = b;
    batch.contact[lane] = head.contact;
  }
}

// What the rows ask of the moving bodies.
void ContactSolver::note_bodies(const std::vector<Body>& bodies) {
  terms_.assign(moving_.size() + 1, {});
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const Body& body = bodies[moving_[i]];
    BodyTerms& t = terms_[i];
    for (int k = 0; k < 3; ++k) {
      t.row0[k] = body.inverse_inertia.rows[0][k];
      t.row1[k] = body.inverse_inertia.rows[1][k];
      t.row2[k] = body.inverse_inertia.rows[2][k];
    }
    t.share = share_[i];
    t.inverse_mass = body.inverse_mass * t.share;
    t.mass = float(body.mass) / t.share;
  }
}

void ContactSolver::run_substeps(const SolverSettings& settings) {
  const float h = settings.step / float(settings.substeps);
  const Quad fall{0, 0, -settings.gravity * h, 0};
  const Quad wide_h = make_quad(h);
  const float per_substep = 1 / h, weight = settings.gravity * h;
  const bool trees = !tree_contacts_.empty();
  const BatchRange all = range(0, int(batches_.size()));
  for (int substep = 0; substep < settings.substeps; ++substep) {
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      speeds_[i].linear += fall * make_quad(share_[i]);
    }
    kernels_.warm_start(all, speeds_.data());
    if (trees) tree_contacts_.begin_substep(speeds_.data(), substep == 0, double(weight));
    kernels_.solve_velocities(all, per_substep, weight, moved_.data(), speeds_.data());
    if (trees) {
      tree_contacts_.solve_velocities(1 / double(h), moved_.data(), speeds_.data());
      tree_contacts_.end_substep();
    }
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      moved_[i].linear += speeds_[i].linear * wide_h;
      moved_[i].angular += speeds_[i].angular * wide_h;
    }
  }
  if (trees) tree_contacts_.end_substeps(double(weight));
}

BatchRange ContactSolver::range(int begin, int end) {
  return {batches_.data() + begin, batches_.data() + end, rows_.data(), pushes_.data()};
}

template <typename Action>
void ContactSolver::each_batch(ThreadPool& pool, Action&& action) {
  pool.run(int(batches_.size()), 8, [&](int begin, int end) { action(range(begin, end)); });
}

// n . (d_b - d_a) >= target for every point, by pushing only. Where nothing is to be pushed, and no
// neighbour has been, a batch would change nothing.
void ContactSolver::push_apart(const SolverSettings& settings, ThreadPool& pool) {
  wants_push_.assign(batches_.size(), 0);
  const PushTerms terms{settings.slop, settings.position_fraction, settings.maximum_push};
  each_batch(pool, [&](const BatchRange& part) {
    for (const ContactBatch* batch = part.begin; batch != part.end; ++batch) {
      wants_push_[std::size_t(batch - batches_.data())] =
          kernels_.begin_pushes(*batch, &rows_[batch->first_row], &pushes_[batch->first_row],
                                terms, moved_.data());
    }
  });
  const bool trees = !tree_contacts_.empty();
  const bool tree_pushes = trees && tree_contacts_.begin_pushes(settings, moved_.data());
  const bool any = std::find(wants_push_.begin(), wants_push_.end(), 1) != wants_push_.end();
  if (!any && !tree_pushes) return;
  pushed_.assign(moving_.size() + 1, trees ? 1 : 0);
  for (int iteration = 0; iteration < settings.position_iterations; ++iteration) {
    for (std::size_t i = 0; i < batches_.size(); ++i) {
      const ContactBatch& batch = batches_[i];
      if (!wants_push_[i] && !is_pushed(batch)) continue;
      wants_push_[i] = 1;
      if (kernels_.solve_pushes(batch, &rows_[batch.first_row], &pushes_[batch.first_row],
                                moved_.data())) {
        for (int lane = 0; lane < kLanes; ++lane) {
          pushed_[batch.a[lane]] = pushed_[batch.b[lane]] = 1;
        }
        pushed_[moving_.size()] = 0;  // stands for what does not move
      }
    }
    if (trees) tree_contacts_.solve_pushes(moved_.data());
  }
}

bool ContactSolver::is_pushed(const ContactBatch& batch) const {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (pushed_[batch.a[lane]] || pushed_[batch.b[lane]]) return true;
  }
  return false;
}

// A piece whose speed turns it into its neighbours, step after step, while the pushes turn it back,
// does not go anywhere: the part of its speed that was undone is lost. Only for slow pieces, whose
// momentum is nothing beside that of the weights they carry.
void ContactSolver::drop_opposed_speeds(const SolverSettings& settings) {
  const auto drop = [&settings](Quad& speed, Quad push, float slow) {
    const Quad s2 = speed * speed, sp = speed * push;
    const float length2 = s2[0] + s2[1] + s2[2], along = sp[0] + sp[1] + sp[2];
    if (along >= 0 || length2 > slow * slow) return;
    speed *= make_quad(std::max(0.0F, 1 + along / (settings.step * length2)));
  };
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    drop(speeds_[i].linear, moved_[i].linear - before_push_[i].linear, kSlowSpeed);
    drop(speeds_[i].angular, moved_[i].angular - before_push_[i].angular, kSlowSpin);
  }
}

bool ContactSolver::has_intervened(std::int32_t body) const {
  const std::int32_t n = number_[std::size_t(body)];
  if (n == std::int32_t(moving_.size())) return false;
  const auto differ = [](Quad p, Quad q) {
    const Quad d = p - q;
    return d[0] != 0 || d[1] != 0 || d[2] != 0;
  };
  const PaddedMotion &now = moved_[std::size_t(n)], &before = before_push_[std::size_t(n)];
  return share_[std::size_t(n)] < 1 || differ(now.linear, before.linear) ||
         differ(now.angular, before.angular);
}

void ContactSolver::store(const ContactBatch& batch, std::vector<Contact>& contacts) const {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (batch.contact[lane] < 0) continue;
    Contact& contact = contacts[batch.contact[lane]];
    for (int i = 0; i < batch.rows; ++i) {
      contact.points[i].normal_impulse = rows_[batch.first_row + i].impulse[lane];
    }
    const FrictionRow &s = batch.slide[0], &t = batch.slide[1];
    contact.friction_impulse = s.direction.get(lane) * s.impulse[lane] +
                               t.direction.get(lane) * t.impulse[lane];
    contact.twist_impulse = batch.twist_impulse[lane];
    contact.pressed = batch.pressed[lane];
  }
}

void ContactSolver::solve(const SolverSettings& settings, const std::vector<Body>& bodies,
                          const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
                          std::vector<Motion>& velocities, std::vector<Motion>& displacements,
                          const SolvedTrees& trees, ThreadPool& pool) {
  note_heads(bodies, order, contacts, trees, pool);
  number_bodies(bodies);
  share_inertia(bodies);
  pack();
  rows_.resize(std::size_t(row_count_));
  pushes_.resize(std::size_t(row_count_));
  tree_contacts_.begin(settings, bodies, tree_order_, contacts, number_, share_, trees);
  note_bodies(bodies);
  each_batch(pool, [&](const BatchRange& part) {
    kernels_.prepare(part, contacts.data(), terms_.data(), settings.rest_gap);
  });
  speeds_.assign(moving_.size() + 1, {});
  moved_.assign(moving_.size() + 1, {});
  for (std::size_t i = 0; i < moving_.size(); ++i) speeds_[i] = padded(velocities[moving_[i]]);
  run_substeps(settings);
  before_push_ = moved_;
  push_apart(settings, pool);
  drop_opposed_speeds(settings);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    velocities[moving_[i]] = unpadded(speeds_[i]);
    displacements[moving_[i]] = unpadded(moved_[i]);
  }
  each_batch(pool, [&](const BatchRange& part) {
    for (const ContactBatch* batch = part.begin; batch != part.end; ++batch) {
      store(*batch, contacts);
    }
  });
  tree_contacts_.store(bodies, contacts);
}

}  // namespace rubble
