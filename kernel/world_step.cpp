// The stages of one step, in the order of World::step().
#include <algorithm>
#include <chrono>
#include <cmath>

#include "kernel/world_impl.h"

namespace rubble {
namespace {

// A piece falls asleep after it has stayed within this distance for this time.
constexpr double kStillDistance = 0.001;  // of any of its points; unit: m
constexpr double kStillTime = 0.25;       // unit: s
// So does one that jitters, but goes nowhere.
constexpr double kLooseDistance = 0.005;  // unit: m
constexpr double kLooseTime = 1.0;        // unit: s
// A sleeper wakes when the impulse of a contact changes by what would give it this speed.
constexpr float kWakeSpeed = 0.1F;  // unit: m/s
// A sleeper wakes at once when an impact would give it this speed.
constexpr float kHitSpeed = 0.2F;  // unit: m/s
// Overlaps deeper than this keep a piece awake for a while.
constexpr float kWakeLoad = 0.25F;
constexpr float kSleepOverlap = 0.003F;  // unit: m
constexpr double kSleepOverlapTime = 2.0;  // unit: s
constexpr float kMaximumSpin = 30.0F;    // unit: rad/s
constexpr float kMaximumSpeed = 50.0F;   // unit: m/s
// Touching pieces that are slower than this lose a part of their speed in each step, the larger the
// slower they are.
constexpr float kSlowSpin = 1.0F, kSpinDamping = 0.1F;     // unit: rad/s, 1
constexpr float kSlowSpeed = 0.1F, kSpeedDamping = 0.02F;  // unit: m/s, 1
constexpr float kKickShare = 0.35F;  // see limit_kicks()
constexpr float kFreeKick = 1.0F;   // unit: m/s
constexpr float kOrderDistance = 0.1F;  // see sort_by_height(); unit: m
constexpr double kLookAhead = 4;         // steps that an enlarged box reaches ahead

// A contact's impulse must change by this to wake a sleeper. What carries a high load is clamped by
// it, and changes of a fraction of the load do not matter to it.
float wake_impulse(const Body& body) {
  return kWakeSpeed * float(body.mass) + kWakeLoad * body.load;
}
float hit_impulse(const Body& body) { return kHitSpeed * float(body.mass) + body.load; }

std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
}

// The implicit gyroscopic torque, one Newton step (Catto, GDC 2015): stable at any spin.
Vec3 gyroscopic(const Body& body, const Vec3& omega, double dt) {
  const Quat& q = body.world_from_com.rotation;
  const Vec3 w = q.conjugate().rotate(omega);
  const Vec3 iw = body.inertia * w;
  const Vec3 f = cross(w, iw) * dt;
  // J = I + dt ([w]x I - [I w]x)
  const Mat3 skew_w{{{0, -w.z, w.y}, {w.z, 0, -w.x}, {-w.y, w.x, 0}}};
  const Mat3 skew_iw{{{0, -iw.z, iw.y}, {iw.z, 0, -iw.x}, {-iw.y, iw.x, 0}}};
  const Mat3 jacobian = body.inertia + (skew_w * body.inertia + skew_iw * -1.0) * dt;
  const Vec3 c0 = cross(jacobian.rows[1], jacobian.rows[2]);
  const Vec3 c1 = cross(jacobian.rows[2], jacobian.rows[0]);
  const Vec3 c2 = cross(jacobian.rows[0], jacobian.rows[1]);
  const double scale = 1 / dot(jacobian.rows[0], c0);
  const Vec3 change = (c0 * f.x + c1 * f.y + c2 * f.z) * scale;
  return q.rotate(w - change);
}

// Counts the steps that a body has stayed near `pose`; starts anew where it is when it has left.
void count_still(const Body& body, double distance, Pose& pose, std::int32_t& steps) {
  const Vec3 moved = body.world_from_com.translation - pose.translation;
  const Quat turn = pose.rotation.conjugate() * body.world_from_com.rotation;
  // How far a corner has gone at most: a bar may spin about its own axis without going anywhere.
  const Vec3 r = Vec3(body.shape->reach) * (2 * body.scale);
  const Vec3 t{std::abs(turn.x), std::abs(turn.y), std::abs(turn.z)};
  const double turned =
      norm(Vec3{t.y * r.z + t.z * r.y, t.z * r.x + t.x * r.z, t.x * r.y + t.y * r.x});
  ++steps;
  if (norm(moved) + turned > distance) {
    pose = body.world_from_com;
    steps = 0;
  }
}

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

void World::Impl::wake(int index) {
  Body& body = data.bodies[index];
  if (!body.movable() || body.awake) return;
  body.awake = true;
  body.still_steps = body.loose_steps = 0;
  body.still_pose = body.loose_pose = body.world_from_com;
}

void World::Impl::fall_asleep(int index) {
  Body& body = data.bodies[index];
  body.awake = false;
  blocks.set_velocity(body.mobile, {}, {});
  body.linear = {};
  body.angular = {};
}

void World::Impl::wake_marked() {
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    if (data.wake_next[i]) wake(int(i));
    data.wake_next[i] = 0;
  }
}

void World::Impl::add_contact(int first, int second) {
  const int a = second == kGround ? first : std::min(first, second);
  const int b = second == kGround ? kGround : std::max(first, second);
  const std::int32_t body_a = data.colliders[a].body;
  const std::int32_t body_b = b == kGround ? kGround : data.colliders[b].body;
  if (body_a == body_b) return;
  const Body& one = data.bodies[body_a];
  if (b != kGround && !one.movable() && !data.bodies[body_b].movable()) return;
  if (!data.contact_of_pair.insert({pair_key(a, b), std::int32_t(data.contacts.size())}).second) {
    return;
  }
  Contact contact;
  contact.body_a = body_a;
  contact.body_b = body_b;
  const double mu_a = types[one.type].friction;
  const double mu_b = b == kGround ? mu_a : types[data.bodies[body_b].type].friction;
  contact.friction = float(std::sqrt(mu_a * mu_b));
  data.pairs.push_back({a, b, body_a, body_b});
  data.contacts.push_back(contact);
}

void World::Impl::remove_contact(std::size_t index) {
  const Pair pair = data.pairs[index];
  for (std::int32_t body : {pair.body_a, pair.body_b}) {
    // A sleeper that loses a support wakes.
    if (body == kGround || data.bodies[body].awake || !data.bodies[body].movable()) continue;
    if (data.contacts[index].rest_pressed > wake_impulse(data.bodies[body])) {
      data.wake_next[body] = 1;
    }
  }
  data.contact_of_pair.erase(pair_key(pair.collider_a, pair.collider_b));
  if (index + 1 < data.pairs.size()) {
    const Pair& moved = data.pairs[index] = data.pairs.back();
    data.contacts[index] = data.contacts.back();
    data.contact_of_pair[pair_key(moved.collider_a, moved.collider_b)] = std::int32_t(index);
  }
  data.pairs.pop_back();
  data.contacts.pop_back();
}

void World::Impl::find_pairs() {
  for (const Body& body : data.bodies) {
    if (!body.awake) continue;
    const Vec3 motion = Vec3(body.linear) * options.step;
    const double turning = double(norm(body.angular) * body.radius) * options.step;
    for (int i = 0; i < body.collider_count; ++i) {
      const int collider = body.first_collider + i;
      Aabb box = data.colliders[collider].box;  // and all that it may sweep in this step
      box.min += min(motion, Vec3{}) - Vec3{turning, turning, turning};
      box.max += max(motion, Vec3{}) + Vec3{turning, turning, turning};
      if (!data.broad.update(collider, box, motion * kLookAhead)) continue;
      data.broad.query(collider, [&](int other) { add_contact(collider, other); });
      if (data.broad.box(collider).min.z < 0) add_contact(collider, kGround);
    }
  }
}

// Lists the pairs with somebody awake that may touch in this step, and drops those that are apart.
void World::Impl::select_pairs() {
  active.clear();
  for (std::size_t i = 0; i < data.pairs.size();) {
    Pair& pair = data.pairs[i];
    const bool ground = pair.body_b == kGround;
    if (!data.bodies[pair.body_a].awake && (ground || !data.bodies[pair.body_b].awake)) {
      ++i;
      continue;
    }
    const Aabb& box = data.broad.box(pair.collider_a);
    const bool near =
        ground ? box.min.z < 0 : BroadPhase::overlap(box, data.broad.box(pair.collider_b));
    if (!near) {
      remove_contact(i);
      continue;
    }
    if (may_touch(pair)) {
      active.push_back(std::int32_t(i));
    } else if (pair.live) {
      clear_points(data.contacts[i]);
      pair.live = 0;
    }
    ++i;
  }
}

// Whether the boxes can meet in this step.
bool World::Impl::may_touch(const Pair& pair) const {
  const Body& a = data.bodies[pair.body_a];
  const Aabb& box = data.colliders[pair.collider_a].box;
  if (pair.body_b == kGround) {
    return box.min.z < double(motion_margin(a, nullptr, narrow_settings));
  }
  const double margin = motion_margin(a, &data.bodies[pair.body_b], narrow_settings);
  const Aabb& other = data.colliders[pair.collider_b].box;
  return box.min.x <= other.max.x + margin && other.min.x <= box.max.x + margin &&
         box.min.y <= other.max.y + margin && other.min.y <= box.max.y + margin &&
         box.min.z <= other.max.z + margin && other.min.z <= box.max.z + margin;
}

void World::Impl::update_contacts() {
  pool.run(int(active.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data.pairs[active[i]];
      Contact& contact = data.contacts[active[i]];
      const Body& body = data.bodies[pair.body_a];
      const PosedBody a = posed(data.colliders[pair.collider_a]);
      if (pair.collider_b == kGround) {
        const float margin = motion_margin(body, nullptr, narrow_settings);
        update_ground_contact(contact, a, margin, narrow_settings);
      } else {
        const float margin = motion_margin(body, &data.bodies[pair.body_b], narrow_settings);
        update_contact(contact, a, posed(data.colliders[pair.collider_b]), margin,
                       narrow_settings);
      }
      pair.live = contact.count > 0;
    }
  });
}

// A sleeper that is about to be hit hard enough takes part in this very step, so that momentum is
// kept. Its other contacts are as it left them: neither side has moved.
void World::Impl::wake_hit() {
  bool any = false;
  for (std::int32_t index : active) {
    if (!data.pairs[index].live) continue;
    const Contact& contact = data.contacts[index];
    if (contact.body_b == kGround) continue;
    const Body &a = data.bodies[contact.body_a], &b = data.bodies[contact.body_b];
    if (a.awake == b.awake) continue;
    const Body& sleeper = a.awake ? b : a;
    if (!sleeper.movable()) continue;
    const float inverse_masses = a.inverse_mass + b.inverse_mass;
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& p = contact.points[i];
      const Vec3f v = b.linear + cross(b.angular, p.from_b) - a.linear - cross(a.angular, p.from_a);
      const float approach = -dot(contact.normal, v);
      if (p.separation - approach * solver_settings.step > solver_settings.rest_gap) continue;
      // The impulse of a central plastic impact.
      if (approach < inverse_masses * hit_impulse(sleeper)) continue;
      wake(a.awake ? contact.body_b : contact.body_a);
      any = true;
      break;
    }
  }
  if (!any) return;
  std::vector<std::uint8_t> listed(data.pairs.size(), 0);
  for (std::int32_t index : active) listed[index] = 1;
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    const Pair& pair = data.pairs[i];
    if (listed[i] || !pair.live) continue;
    const bool awake = data.bodies[pair.body_a].awake ||
                       (pair.body_b != kGround && data.bodies[pair.body_b].awake);
    if (awake) active.push_back(std::int32_t(i));
  }
}

// Gyroscopic torque only; the solver adds gravity in its substeps.
void World::Impl::apply_forces() {
  velocities.assign(data.bodies.size(), {});
  displacements.assign(data.bodies.size(), {});
  pool.run(int(data.bodies.size()), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Body& body = data.bodies[i];
      if (!body.awake) continue;
      const Vec3 w = gyroscopic(body, blocks.angular_velocity(body.mobile), options.step);
      velocities[i] = {body.linear, Vec3f(w)};
    }
  });
}

// Bottom up: what carries is solved before what is carried. The order stays the same from step to
// step unless something moves far: a sweep in another order would disturb what earlier ones reached.
void World::Impl::sort_by_height() {
  std::vector<std::pair<float, std::int32_t>> keys;
  for (std::int32_t index : active) {
    Pair& pair = data.pairs[index];
    const float z = float(data.bodies[pair.body_a].world_from_com.translation.z) +
                    data.contacts[index].points[0].from_a.z;
    if (std::abs(z - pair.order) > kOrderDistance) pair.order = z;
    keys.push_back({pair.order, index});
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) active[i] = keys[i].second;
}

void World::Impl::solve_contacts() {
  active.erase(std::remove_if(active.begin(), active.end(),
                              [&](std::int32_t i) { return !data.pairs[i].live; }),
               active.end());
  sort_by_height();
  solver.solve(solver_settings, data.bodies, active, data.contacts, velocities, displacements);
}

// A piece squeezed out from under a heavy one must not shoot away: sideways and upwards it may
// become no faster in one step than a share of the speed that the fastest neighbour had before.
void World::Impl::limit_kicks() {
  fastest.assign(data.bodies.size(), 0);
  const auto reach = [this](std::int32_t i) {
    const Body& body = data.bodies[i];
    return norm(body.linear) + norm(body.angular) * body.radius;
  };
  for (std::int32_t index : active) {
    const Contact& contact = data.contacts[index];
    if (contact.body_b == kGround || contact.pressed <= 0) continue;
    fastest[contact.body_a] = std::max(fastest[contact.body_a], reach(contact.body_b));
    fastest[contact.body_b] = std::max(fastest[contact.body_b], reach(contact.body_a));
  }
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    const Body& body = data.bodies[i];
    if (!body.awake || !body.touching) continue;
    const auto outwards = [](const Vec3f& v) { return Vec3f{v.x, v.y, std::max(v.z, 0.0F)}; };
    const float before = norm(outwards(body.linear)), after = norm(outwards(velocities[i].linear));
    const float fall = float(options.gravity * options.step);
    const float most = std::max(before + fall, kKickShare * fastest[i] + kFreeKick);
    if (after <= most) continue;
    const float keep = most / after;
    for (Vec3f* v : {&velocities[i].linear, &displacements[i].linear}) {
      v->x *= keep, v->y *= keep;
      if (v->z > 0) v->z *= keep;
    }
  }
}

// The speeds after the step, and the extra rates that make up its displacement.
void World::Impl::set_rates(std::size_t index) {
  const Body& body = data.bodies[index];
  Vec3 v, w;
  if (body.touching) {
    Motion m = velocities[index];
    const float spin = norm(m.angular), speed = norm(m.linear);
    if (spin > kMaximumSpin) m.angular *= kMaximumSpin / spin;
    if (speed > kMaximumSpeed) m.linear *= kMaximumSpeed / speed;
    // Grinding of rough surfaces, for pieces that are nearly at rest.
    if (spin < kSlowSpin) m.angular *= 1 - kSpinDamping * (1 - spin / kSlowSpin);
    if (speed < kSlowSpeed) m.linear *= 1 - kSpeedDamping * (1 - speed / kSlowSpeed);
    v = Vec3(m.linear), w = Vec3(m.angular);
    const double per_step = 1 / options.step;
    extra_linear[body.mobile] = Vec3(displacements[index].linear) * per_step - v;
    extra_angular[body.mobile] = Vec3(displacements[index].angular) * per_step - w;
  } else {
    // Nothing touches it: the exact parabola, in double precision.
    v = blocks.linear_velocity(body.mobile);
    w = gyroscopic(body, blocks.angular_velocity(body.mobile), options.step);
    v.z -= options.gravity * options.step;
    extra_linear[body.mobile] = {0, 0, 0.5 * options.gravity * options.step};
    extra_angular[body.mobile] = {};
  }
  blocks.set_velocity(body.mobile, v, w);
}

void World::Impl::advance() {
  moves.assign(blocks.size(), 0);
  extra_linear.resize(blocks.size());
  extra_angular.resize(blocks.size());
  std::vector<std::uint8_t> block_awake(blocks.block_count(), 0);
  std::vector<std::int32_t> body_of(blocks.size(), 0);
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    const Body& body = data.bodies[i];
    if (!body.awake) continue;
    moves[body.mobile] = 1;
    body_of[body.mobile] = std::int32_t(i);
    block_awake[blocks.block_of_body(body.mobile)] = 1;
    set_rates(i);
  }
  pool.run(blocks.block_count(), 4, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      if (!block_awake[block]) continue;
      blocks.advance(block, moves, extra_linear.data(), extra_angular.data(), options.step);
      for (int mobile = blocks.first_of(block); mobile < blocks.first_of(block + 1); ++mobile) {
        if (!moves[mobile]) continue;
        Body& body = data.bodies[body_of[mobile]];
        mirror(body);
        refresh(body);
      }
    }
  });
}

// A contact counts as touching when it carries an impulse.
void World::Impl::update_touching() {
  for (Body& body : data.bodies) {
    if (body.awake) body.touching = false;
  }
  for (std::int32_t index : active) {
    const Contact& contact = data.contacts[index];
    if (contact.pressed <= 0) continue;
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround) continue;
      data.bodies[i].touching = data.bodies[i].has_touched = true;
    }
  }
}

void World::Impl::update_sleep() {
  // Sleepers that an awake neighbour presses on more, or less, than when they fell asleep.
  for (std::int32_t index : active) {
    const Contact& contact = data.contacts[index];
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround) continue;
      const Body& body = data.bodies[i];
      if (body.awake || !body.movable()) continue;
      const float change = std::abs(contact.pressed - contact.rest_pressed);
      if (change > wake_impulse(body)) data.wake_next[i] = 1;
    }
  }
  if (!options.sleeping) return;
  std::vector<std::uint8_t> overlapping(data.bodies.size(), 0);
  for (std::int32_t index : active) {
    const Contact& contact = data.contacts[index];
    for (int p = 0; p < contact.count; ++p) {
      if (contact.points[p].separation > -kSleepOverlap) continue;
      overlapping[contact.body_a] = 1;
      if (contact.body_b != kGround) overlapping[contact.body_b] = 1;
    }
  }
  const int wait = int(kStillTime / options.step), loose_wait = int(kLooseTime / options.step);
  const int long_wait = int(kSleepOverlapTime / options.step);
  std::vector<std::uint8_t> slept(data.bodies.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    Body& body = data.bodies[i];
    if (!body.awake) continue;
    count_still(body, kStillDistance, body.still_pose, body.still_steps);
    count_still(body, kLooseDistance, body.loose_pose, body.loose_steps);
    if (body.still_steps >= (overlapping[i] ? long_wait : wait) ||
        body.loose_steps >= (overlapping[i] ? long_wait : loose_wait)) {
      fall_asleep(int(i));
      slept[i] = 1;
      any = true;
    }
  }
  if (!any) return;
  for (std::size_t i = 0; i < slept.size(); ++i) {
    if (slept[i]) data.bodies[i].load = 0;
  }
  for (std::int32_t index : active) {
    Contact& contact = data.contacts[index];
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround || !slept[i]) continue;
      data.bodies[i].load += contact.pressed;
      contact.rest_pressed = contact.pressed;
    }
  }
}

void World::Impl::lose(int index) {
  Body& body = data.bodies[index];
  body.lost = true;
  body.awake = false;
  body.touching = false;
  ++data.lost;
  blocks.set_velocity(body.mobile, {}, {});
  for (std::size_t i = 0; i < data.pairs.size();) {
    if (data.pairs[i].body_a == index || data.pairs[i].body_b == index) {
      remove_contact(i);
    } else {
      ++i;
    }
  }
  for (int i = 0; i < body.collider_count; ++i) data.broad.remove(body.first_collider + i);
}

void World::Impl::remove_lost() {
  for (std::size_t i = 0; i < data.bodies.size(); ++i) {
    const Body& body = data.bodies[i];
    if (!body.awake) continue;
    const Vec3 p = body.world_from_type().translation;
    // Written so that a pose that is not a number is lost too.
    const bool inside = p.z >= options.lost_below &&
                        p.x * p.x + p.y * p.y <= options.lost_beyond * options.lost_beyond;
    if (!inside) lose(int(i));
  }
}

void World::step() {
  Impl& w = *impl_;
  {
    const Stopwatch watch(w.times.broad);
    w.wake_marked();
    w.find_pairs();
    w.select_pairs();
  }
  {
    const Stopwatch watch(w.times.narrow);
    w.update_contacts();
    w.wake_hit();
  }
  {
    const Stopwatch watch(w.times.solve);
    w.apply_forces();
    w.solve_contacts();
  }
  {
    const Stopwatch watch(w.times.rest);
    w.update_touching();
    w.limit_kicks();
  }
  {
    const Stopwatch watch(w.times.advance);
    w.advance();
  }
  {
    const Stopwatch watch(w.times.rest);
    w.update_sleep();
    w.remove_lost();
  }
  ++w.data.steps;
}

}  // namespace rubble
