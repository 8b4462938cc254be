// Before the sweeps of a step: which bodies move, which thread has them, who counts as heavier than it is,
// and which contacts share a batch.
#include <algorithm>

#include "kernel/solver/contact_solver.h"

namespace rubble {
namespace {

// Largest ratio of the mass of a carried piece to that of the piece below it, see share_inertia().
constexpr double kMassRatio = 2;
constexpr float kAbove = 0.2F;       // a piece carries another if the vertical part of the normal is larger
constexpr float kCarrySpeed = 0.5F;  // only slower pieces count as carrying; unit: m/s
// A thread takes part in the sweeps if there are this many contacts for it.
constexpr int kLeastContacts = 150;
constexpr int kMostDomains = 16;  // largest number of threads that share the sweeps

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
      heads_[i] = {order[i], contact.body_a, contact.body_b, contact.count, contact.normal,
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
  constexpr std::int32_t kUnseen = -1;  // the body has no number yet
  constexpr std::int32_t kStays = -2;   // the body never gets a number, because it does not move
  number_.assign(bodies.size(), kUnseen);
  for (const Head& head : heads_) {
    for (std::int32_t body : {head.body_a, head.body_b}) {
      if (body == kGround || number_[body] != kUnseen) continue;
      number_[body] = bodies[body].awake && bodies[body].tree < 0 ? 0 : kStays;
    }
  }
  moving_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (number_[i] == 0) moving_.push_back(std::int32_t(i));
  }
  divide(bodies);
  for (std::int32_t& n : number_) n = std::int32_t(moving_.size());
  for (std::size_t i = 0; i < moving_.size(); ++i) number_[moving_[i]] = std::int32_t(i);
}

// Into one domain for each thread: strips of the ground across its longer side, with as many pieces
// each. Pieces of a domain are numbered one after the other, so that threads seldom write to the same line
// of a cache.
void ContactSolver::divide(const std::vector<Body>& bodies) {
  domains_.assign(moving_.size(), 0);
  domain_starts_.assign(std::size_t(domain_count_) + 1, std::int32_t(moving_.size()));
  domain_starts_[0] = 0;
  if (domain_count_ < 2 || moving_.empty()) return;
  note_places(bodies);
  sorted_places_ = places_;
  std::vector<float> borders;
  auto begin = sorted_places_.begin();
  for (int domain = 1; domain < domain_count_; ++domain) {
    const auto border = sorted_places_.begin() +
                        std::ptrdiff_t(moving_.size() * std::size_t(domain) / std::size_t(domain_count_));
    std::nth_element(begin, border, sorted_places_.end());
    borders.push_back(*border);
    begin = border;
  }
  const std::vector<std::int32_t> before = moving_;
  std::vector<std::vector<std::int32_t>> members(static_cast<std::size_t>(domain_count_));
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto domain = std::upper_bound(borders.begin(), borders.end(), places_[i]) - borders.begin();
    members[std::size_t(domain)].push_back(before[i]);
  }
  moving_.clear();
  for (std::size_t domain = 0; domain < members.size(); ++domain) {
    domain_starts_[domain] = std::int32_t(moving_.size());
    std::fill_n(domains_.begin() + std::ptrdiff_t(moving_.size()), members[domain].size(),
                std::uint8_t(domain));
    moving_.insert(moving_.end(), members[domain].begin(), members[domain].end());
  }
}

// Along the longer side of the ground that they lie on.
void ContactSolver::note_places(const std::vector<Body>& bodies) {
  float low[2] = {1e30F, 1e30F}, high[2] = {-1e30F, -1e30F};
  places_.clear();
  sorted_places_.clear();  // here those across
  for (std::int32_t body : moving_) {
    const Vec3 at = bodies[body].world_from_com.translation;
    const float place[2] = {float(at.x), float(at.y)};
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
    places_.push_back(place[0]);
    sorted_places_.push_back(place[1]);
  }
  if (high[1] - low[1] > high[0] - low[0]) places_.swap(sorted_places_);
}

// Joins all that touches; what does not move has the number behind the last.
void ContactSolver::find_supported() {
  const std::int32_t beyond = std::int32_t(moving_.size());
  touching_.reset(moving_.size() + 1);
  for (const Head& head : heads_) touching_.join(number_[head.body_a], head.body_b == kGround ? beyond : number_[head.body_b]);
  supported_.resize(moving_.size());
  const std::int32_t ground = touching_.find(beyond);
  for (std::int32_t i = 0; i < beyond; ++i) supported_[std::size_t(i)] = touching_.find(i) == ground;
}

// A light piece under a heavy one carries a load of many times its weight, which the sweeps reach
// only after as many rounds, and in the meantime the heavy one bounces on it. While it is slow, its
// inertia (not its weight) counts as at least 1/kMassRatio of what lies on it: loads at rest stay
// exact, and momentum that goes into the light piece is lost, never gained. What nothing holds up from
// below carries nothing, nor does what is in the air with all that it touches: momentum is kept there.
// A light piece between a heavy one and what does not move counts as heavier too, whichever way it is pressed.
void ContactSolver::share_inertia(const std::vector<Body>& bodies) {
  find_supported();
  share_.assign(moving_.size() + 1, 1.0F);
  held_.assign(moving_.size() + 1, 0);
  backed_.assign(moving_.size() + 1, {});
  const auto moves = [&](std::int32_t body) { return body != kGround && bodies[body].movable(); };
  for (const Head& head : heads_) {
    const std::int32_t a = number_[head.body_a];
    const std::int32_t b = head.body_b == kGround ? std::int32_t(moving_.size()) : number_[head.body_b];
    if (head.normal.z < -kAbove) held_[a] = 1;
    if (head.normal.z > kAbove) held_[b] = 1;
    if (!moves(head.body_b)) backed_[a] += head.normal;
    if (!moves(head.body_a)) backed_[b] -= head.normal;
  }
  // press: the way in which the heavy one presses, unit length.
  const auto carry = [&](std::int32_t light, std::int32_t heavy, const Vec3f& press) {
    const std::int32_t number = number_[light];
    if (number == std::int32_t(moving_.size())) return;
    const Body &l = bodies[light], &h = bodies[heavy];
    const bool carries = press.z < -kAbove && held_[number] != 0 && is_supported(number);
    const bool is_backed = dot(backed_[number], press) > kAbove;
    if (!h.awake || (!carries && !is_backed)) return;
    // What is pressed against what does not move goes nowhere, however fast it was pushed.
    const float towards = is_backed ? std::max(0.0F, dot(l.linear, press)) : 0;
    if (dot(l.linear, l.linear) - towards * towards > kCarrySpeed * kCarrySpeed) return;
    const float share = float(kMassRatio * l.mass / h.mass);
    share_[number] = std::min(share_[number], share);
  };
  for (const Head& head : heads_) {
    if (head.body_b == kGround) continue;
    carry(head.body_a, head.body_b, -head.normal);
    carry(head.body_b, head.body_a, head.normal);
  }
}

// While a pile lies awake, its contacts stay the same from step to step, and so does the plan.
bool ContactSolver::note_touches() {
  const std::int32_t beyond = std::int32_t(moving_.size());
  touches_.clear();
  for (const Head& head : heads_) {
    if (head.tree) continue;
    const std::int32_t b = head.body_b == kGround ? beyond : number_[head.body_b];
    touches_.push_back({head.contact, number_[head.body_a], b, head.count});
  }
  touches_.swap(planned_);
  const bool same = !planned_.empty() && plan_.domain_count() == domain_count_ && domains_ == planned_domains_ &&
                    planned_ == touches_;
  planned_domains_ = domains_;
  return same;
}

void ContactSolver::pack() {
  if (note_touches()) return;
  colours_.begin(moving_.size());
  for (std::size_t i = 0; i < planned_.size(); ++i) colours_.add(std::int32_t(i), planned_[i].a, planned_[i].b);
  plan_.begin(domain_count_, domains_);
  for (std::int32_t i : colours_.finish()) {
    const Touch& touch = planned_[i];
    plan_.add(touch.contact, touch.a, touch.b, touch.rows);
  }
  plan_.finish();
  batches_.resize(std::size_t(plan_.batch_count()));
  std::int32_t rows = 0;
  for (int i = 0; i < plan_.batch_count(); ++i) {
    batches_[i].first_row = rows;
    rows += batches_[i].rows = plan_.batch(i).rows;
  }
  rows_.resize(std::size_t(rows));
  pushes_.resize(std::size_t(rows));
}

// Threads take part where there is enough to do for each, unless other programs kept them from it lately:
// waiting for a thread that does not run costs more than doing its work. Contacts of trees are not in the
// sweeps, so they do not count: where trees alone move, there is nothing to divide.
int ContactSolver::choose_domain_count(ThreadPool& pool) {
  const int swept = int(heads_.size() - tree_order_.size());
  const int most = std::min({pool.threads(), swept / kLeastContacts, kMostDomains});
  return most < 2 || pool.crowded() ? 1 : most;
}

SweepFigures ContactSolver::plan_sweeps(int threads, const std::vector<Body>& bodies) const {
  ContactSolver other;
  const auto moves = [&bodies](std::int32_t body) {
    return body != kGround && bodies[body].awake && bodies[body].tree < 0;
  };
  for (const Head& head : heads_) {
    if (!head.tree && (moves(head.body_a) || moves(head.body_b))) other.heads_.push_back(head);
  }
  other.domain_count_ = std::clamp(threads, 1, kMostDomains);
  other.number_bodies(bodies);
  other.pack();
  return other.plan_.figures();
}

}  // namespace rubble
