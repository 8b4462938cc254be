#include "kernel/solver/contact_solver.h"

#include <algorithm>
#include <atomic>

namespace rubble {
namespace {

// A speed that a position correction opposes is removed if it is below this; see cancel_correction_velocity().
constexpr float kSlowSpeed = 0.2F;  // unit: m/s
// The same for angular speeds. unit: rad/s
constexpr float kSlowSpin = 2.0F;

// Bodies that a thread takes at once; fewer are not worth the call.
constexpr int kBodyGrain = 256;

PaddedMotion padded(const Motion& m) {
  return {Quad{m.linear.x, m.linear.y, m.linear.z, 0},
          Quad{m.angular.x, m.angular.y, m.angular.z, 0}};
}
Motion unpadded(const PaddedMotion& m) {
  return {{m.linear[0], m.linear[1], m.linear[2]}, {m.angular[0], m.angular[1], m.angular[2]}};
}
// Speeds that die away end before they are subnormal numbers; as contact_law::kTinySpeed. unit: m/s, rad/s
Quad drop_tiny(Quad speed) {
  const Quad tiny = make_quad(1e-15F);
  return Quad((QuadMask(speed) & (speed > tiny)) | (QuadMask(speed) & (speed < -tiny)));
}

}  // namespace

// What the rows ask of the moving bodies.
void ContactSolver::note_bodies(const std::vector<Body>& bodies) {
  terms_.assign(slot_count(), {});
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

void ContactSolver::note_motions(const std::vector<Motion>& velocities) {
  speeds_.assign(slot_count(), {});
  moved_.assign(slot_count(), {});
  for (std::size_t i = 0; i < moving_.size(); ++i) speeds_[i] = padded(velocities[moving_[i]]);
}

// Which contacts share a batch, and what the solver asks of the bodies: neither reads what the other writes.
void ContactSolver::pack_and_note(const std::vector<Body>& bodies, const std::vector<Motion>& velocities,
                                  ThreadPool& pool) {
  const auto note = [&] {
    share_inertia(bodies);
    note_bodies(bodies);
    note_motions(velocities);
  };
  pool.run(2, 1, [&](int begin, int end) {
    for (int job = begin; job < end; ++job) job == 0 ? pack() : note();
  });
}

// One substep after another. Whoever is at a domain that shares a body with another waits for it as the plan says, also
// from one sweep to the next, and whoever moves its bodies waits until the others have left them. So each number of a
// body is written and read by one thread after the other. All meet only where trees are solved between two sweeps.
//
// Each thread begins with a domain of its own. Where that must wait for long, or is done, it goes on with any that nobody is
// at: so nobody waits for a thread that comes late or never, only for one that lost its processor within a batch.
// No result depends on who does what.
class ContactSolver::Sweeper {
 public:
  Sweeper(ContactSolver& solver, const SolverSettings& settings)
      : s_(solver),
        substeps_(settings.substeps),
        iterations_(settings.position_iterations),
        h_(settings.step / float(settings.substeps)),
        weight_(settings.gravity * h_),
        trees_(!solver.tree_contacts_.empty()),
        stands_(std::size_t(solver.domain_count_)),
        progress_(solver.domain_count_) {}

  void solve_velocities(ThreadPool& pool) {
    run(pool, [this](int domain) { return advance(domain); });
  }
  void push(ThreadPool& pool) {
    run(pool, [this](int domain) { return advance_push(domain); });
  }

 private:
  // Where a domain stands: what it does next.
  enum class Stage { begin, warm_start, begin_trees, meet_after_warm_start, solve, solve_trees, meet_after_solve };
  struct Stand {
    int round = 0;  // substep or iteration
    Stage stage = Stage::begin;
    std::size_t segment = 0;
    bool done = false;
  };

  // advance(domain): does the next thing; false: it must wait for another domain.
  template <typename Advance>
  void run(ThreadPool& pool, const Advance& advance) {
    left_ = s_.domain_count_;
    double in_vain = 0;  // unit: s
    pool.run_with_help(s_.domain_count_, [&](int thread) {
      IdleWait wait(thread == 0);
      while (left_.load(std::memory_order_acquire) > 0) {
        if (go_on_with(thread, advance) || (wait.at_length() && help(thread, advance))) {
          wait.reset();
        } else if (!wait.pause()) {
          return;
        }
      }
      if (thread == 0) in_vain = wait.in_vain();
    });
    if (in_vain > 0) pool.note_wait(in_vain);
  }
  template <typename Advance>
  bool help(int thread, const Advance& advance) {
    for (int k = 1; k < s_.domain_count_; ++k)
      if (go_on_with((thread + k) % s_.domain_count_, advance)) return true;
    return false;
  }
  // Until it must wait. False: there was nothing to do.
  template <typename Advance>
  bool go_on_with(int domain, const Advance& advance) {
    if (!progress_.take(domain)) return false;
    Stand& stand = stands_[std::size_t(domain)];
    bool any = false;
    while (!stand.done && advance(domain)) any = true;
    if (any && stand.done) left_.fetch_sub(1, std::memory_order_release);
    progress_.give_back(domain);
    return any;
  }

  bool advance(int domain) {
    Stand& stand = stands_[std::size_t(domain)];
    const std::int64_t start = stand.round * step_length(), solve = start + length();
    switch (stand.stage) {
      case Stage::begin:
        if (stand.round > 0) {
          if (!have_left(domain, start)) return false;
          move(domain);
        }
        if (stand.round == substeps_) return stand.done = true;
        fall(domain);
        progress_.reach(domain, start);
        return go_on(stand, Stage::warm_start);
      case Stage::warm_start:
        if (is_swept(domain)) return go_on(stand, trees_ ? Stage::begin_trees : Stage::meet_after_warm_start);
        return sweep(domain, start, true, [this](const SweepSegment& segment) {
          s_.kernels_.warm_start(s_.range(segment.begin, segment.end), s_.speeds_.data());
        });
      case Stage::begin_trees:
        return let_trees(domain, solve, Stage::meet_after_warm_start, [&] { begin_trees(stand.round == 0); });
      case Stage::meet_after_warm_start:
        progress_.reach(domain, solve);
        if (trees_ && !progress_.all_reached(solve)) return false;
        return go_on(stand, Stage::solve);
      case Stage::solve:
        if (is_swept(domain)) return trees_ ? go_on(stand, Stage::solve_trees) : begin_round(stand);
        return sweep(domain, solve, false, [&](const SweepSegment& segment) {
          s_.kernels_.solve_velocities(s_.range(segment.begin, segment.end), is_backwards(stand.round), 1 / h_, weight_,
                                       s_.moved_.data(), s_.speeds_.data());
        });
      case Stage::solve_trees:
        return let_trees(domain, solve + length(), Stage::meet_after_solve, [&] { solve_trees(); });
      case Stage::meet_after_solve:
        return progress_.all_reached(solve + length()) && begin_round(stand);
    }
    return false;
  }

  bool advance_push(int domain) {
    Stand& stand = stands_[std::size_t(domain)];
    const std::int64_t start = stand.round * (trees_ ? 2 : 1) * length();
    switch (stand.stage) {
      case Stage::begin:
        if (stand.round == iterations_) return stand.done = true;
        progress_.reach(domain, start);
        return go_on(stand, Stage::solve);
      case Stage::solve:
        if (is_swept(domain)) return trees_ ? go_on(stand, Stage::solve_trees) : begin_round(stand);
        return sweep(domain, start, false, [this](const SweepSegment& segment) {
          for (int i = segment.begin; i < segment.end; ++i) s_.push(i);
        });
      case Stage::solve_trees:
        return let_trees(domain, start + length(), Stage::meet_after_solve,
                         [&] { s_.tree_contacts_.solve_pushes(s_.moved_.data()); });
      default:
        return progress_.all_reached(start + length()) && begin_round(stand);
    }
  }

  static bool go_on(Stand& stand, Stage stage) {
    stand.stage = stage, stand.segment = 0;
    return true;
  }
  static bool begin_round(Stand& stand) {
    ++stand.round;
    return go_on(stand, Stage::begin);
  }
  bool is_swept(int domain) const {
    return stands_[std::size_t(domain)].segment == s_.plan_.segments(domain).size();
  }

  // A sweep favours the point that it comes to last; always the same one would push a tower over. There, back,
  // back and there again, the four errors cancel.
  static bool is_backwards(int substep) { return substep % 4 == 1 || substep % 4 == 2; }
  std::int64_t length() const { return s_.plan_.length(); }
  // Two sweeps, and with trees what they do after each.
  std::int64_t step_length() const { return (trees_ ? 4 : 2) * length(); }

  void move(int domain) {
    const Quad h = make_quad(h_);
    for (int i = s_.domain_starts_[domain]; i < s_.domain_starts_[domain + 1]; ++i) {
      s_.moved_[i].linear += s_.speeds_[i].linear * h;
      s_.moved_[i].angular += s_.speeds_[i].angular * h;
    }
  }
  void fall(int domain) {
    const Quad fallen{0, 0, -weight_, 0};
    for (int i = s_.domain_starts_[domain]; i < s_.domain_starts_[domain + 1]; ++i)
      s_.speeds_[i].linear += fallen * make_quad(s_.share_[i]);
  }
  // Whether all others have met the domain's bodies for the last time in the sweep before.
  bool have_left(int domain, std::int64_t start) const {
    for (int other = 0; other < s_.domain_count_; ++other) {
      const std::int32_t visit = s_.plan_.last_visit(other, domain);
      if (visit != SweepPlan::kAnyTime && !progress_.reached(other, start - step_length() + length() + visit)) return false;
    }
    return true;
  }
  // The next segment. begins: bodies were moved by their owners before the sweep.
  template <typename Action>
  bool sweep(int domain, std::int64_t start, bool begins, const Action& action) {
    Stand& stand = stands_[std::size_t(domain)];
    const SweepSegment& segment = s_.plan_.segments(domain)[stand.segment];
    if (segment.needs >= 0 && !is_ready(segment, start, begins)) return false;
    action(segment);
    progress_.reach(domain, start + segment.time);
    ++stand.segment;
    return true;
  }
  bool is_ready(const SweepSegment& segment, std::int64_t start, bool begins) const {
    const std::int32_t* needs = s_.plan_.needs(segment);
    for (int other = 0; other < s_.domain_count_; ++other) {
      if (needs[other] != SweepPlan::kAnyTime && !progress_.reached(other, start + needs[other])) return false;
      if (begins && (segment.owners >> other & 1) != 0 && !progress_.reached(other, start)) return false;
    }
    return true;
  }
  // By one thread, at the end of a sweep, while all others wait; then all meet at `point`.
  template <typename Action>
  bool let_trees(int domain, std::int64_t point, Stage then, const Action& action) {
    progress_.reach(domain, point - 1);
    if (!progress_.all_reached(point - 1)) return false;
    if (domain == 0) action();
    progress_.reach(domain, point);
    return go_on(stands_[std::size_t(domain)], then);
  }
  void begin_trees(bool first) {
    s_.tree_contacts_.begin_substep(s_.speeds_.data(), first, double(weight_));
  }
  void solve_trees() {
    s_.tree_contacts_.solve_velocities(1 / double(h_), s_.moved_.data(), s_.speeds_.data());
    s_.tree_contacts_.end_substep();
  }

  ContactSolver& s_;
  int substeps_, iterations_;
  float h_, weight_;  // unit: s, m/s
  bool trees_;
  std::vector<Stand> stands_;  // by domain; each is of the thread that has taken it
  SweepProgress progress_;
  std::atomic<int> left_{0};  // domains that are not done
};

void ContactSolver::run_substeps(const SolverSettings& settings, ThreadPool& pool) {
  Sweeper sweeper(*this, settings);
  sweeper.solve_velocities(pool);
  const float h = settings.step / float(settings.substeps);
  if (!tree_contacts_.empty()) tree_contacts_.end_substeps(double(settings.gravity * h));
}

std::size_t ContactSolver::slot_count() const {
  return moving_.size() + std::size_t(kImmovableStride * domain_count_);
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
void ContactSolver::solve_position_constraints(const SolverSettings& settings, ThreadPool& pool) {
  wants_push_.assign(batches_.size(), 0);
  const PushTerms terms{settings.slop, settings.position_fraction,
                        settings.maximum_push * (1 - settings.fading), settings.deep,
                        settings.maximum_push};
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
  pushed_.assign(slot_count(), trees ? 1 : 0);
  Sweeper sweeper(*this, settings);
  sweeper.push(pool);
}

// One batch of position correction, where that can change anything.
void ContactSolver::push(int index) {
  const ContactBatch& batch = batches_[index];
  if (!wants_push_[index] && !is_pushed(batch)) return;
  wants_push_[index] = 1;
  if (!kernels_.solve_pushes(batch, &rows_[batch.first_row], &pushes_[batch.first_row],
                             moved_.data())) {
    return;
  }
  const std::int32_t beyond = std::int32_t(moving_.size());
  for (int lane = 0; lane < kLanes; ++lane) {
    if (batch.a[lane] < beyond) pushed_[batch.a[lane]] = 1;
    if (batch.b[lane] < beyond) pushed_[batch.b[lane]] = 1;
  }
}

bool ContactSolver::is_pushed(const ContactBatch& batch) const {
  const std::int32_t beyond = std::int32_t(moving_.size());
  const auto pushed = [&](std::int32_t body) { return body < beyond && pushed_[body] != 0; };
  for (int lane = 0; lane < kLanes; ++lane) {
    if (pushed(batch.a[lane]) || pushed(batch.b[lane])) return true;
  }
  return false;
}

// A piece whose speed turns it into its neighbours, step after step, while the pushes turn it back,
// does not go anywhere: the part of its speed that was undone is lost. Only for slow pieces, whose
// momentum is nothing beside that of the weights they carry, and not for what is in the air.
void ContactSolver::cancel_correction_velocity(const SolverSettings& settings, ThreadPool& pool) {
  const auto drop = [&settings](Quad& speed, Quad push, float slow) {
    const Quad s2 = speed * speed, sp = speed * push;
    const float length2 = s2[0] + s2[1] + s2[2], along = sp[0] + sp[1] + sp[2];
    if (along >= 0 || length2 > slow * slow) return;
    speed *= make_quad(std::max(0.0F, 1 + along / (settings.step * length2)));
  };
  pool.run(int(moving_.size()), kBodyGrain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (!is_supported(std::int32_t(i))) continue;
      drop(speeds_[i].linear, moved_[i].linear - before_push_[i].linear, kSlowSpeed);
      drop(speeds_[i].angular, moved_[i].angular - before_push_[i].angular, kSlowSpin);
    }
  });
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
    contact.highest = batch.highest[lane];
  }
}

void ContactSolver::solve(const SolverSettings& settings, const std::vector<Body>& bodies,
                          const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
                          std::vector<Motion>& velocities, std::vector<Motion>& displacements,
                          const SolvedTrees& trees, ThreadPool& pool) {
  note_heads(bodies, order, contacts, trees, pool);
  domain_count_ = choose_domain_count(pool);
  number_bodies(bodies);
  pack_and_note(bodies, velocities, pool);
  tree_contacts_.begin(settings, bodies, tree_order_, contacts, number_, share_, trees);
  each_batch(pool, [&](const BatchRange& part) {
    for (ContactBatch* batch = part.begin; batch != part.end; ++batch) {
      const PlannedBatch& planned = plan_.batch(int(batch - batches_.data()));
      std::copy_n(planned.a, kLanes, batch->a);
      std::copy_n(planned.b, kLanes, batch->b);
      std::copy_n(planned.contact, kLanes, batch->contact);
      batch->used = planned.used;
    }
    kernels_.prepare(part, contacts.data(), terms_.data(), settings.rest_gap);
  });
  run_substeps(settings, pool);
  before_push_ = moved_;
  solve_position_constraints(settings, pool);
  cancel_correction_velocity(settings, pool);
  pool.run(int(moving_.size()), kBodyGrain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      velocities[moving_[i]] = unpadded({drop_tiny(speeds_[i].linear), drop_tiny(speeds_[i].angular)});
      displacements[moving_[i]] = unpadded(moved_[i]);
    }
  });
  each_batch(pool, [&](const BatchRange& part) {
    for (const ContactBatch* batch = part.begin; batch != part.end; ++batch) {
      store(*batch, contacts);
    }
  });
  tree_contacts_.store(bodies, contacts);
}

}  // namespace rubble
