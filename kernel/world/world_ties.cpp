// Ties: bars that hold two pieces after the concrete around them has failed. Each is solved as a
// contact between its anchors that pulls instead of pushing: its normal points from the second
// anchor to the first, and its gap is what it hangs through.
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// A tie is left out of a step if it is slack by more than this and its ends cannot tighten it in
// the step; unit: m.
constexpr double kSlack = 0.02;
// The distance that the ends may move apart in a step is multiplied by this, because contacts may
// accelerate them. unit: 1
constexpr double kSteps = 2;
// Shortest distance of the anchors that defines a direction. unit: m
constexpr double kShortest = 1e-6;
// Share of its strength that a tie carries across its direction: bars with a moment of 1 kN m carry
// most of a hanging piece over 0.3 m. Without it, hanging pieces swing without end. unit: 1
constexpr float kSideways = 0.2F;
// Largest excess length of a tie that has not yielded. unit: m
constexpr double kMostError = 0.005;
// Pieces that are deeper in each other than this lengthen the tie that pulls them together, by as much in each
// step as follows: the concrete that it presses on spalls. unit: m
constexpr float kSpallingDepth = 0.005F;
constexpr double kSpalls = 0.001;  // how much longer; unit: m
// A tie yields from this share of its largest impulse in a substep on. unit: 1
constexpr float kYields = 0.999F;

// The share of the step for which a tie pulls that is torn within it: what parts fast is gone after
// less than a step, and must not give more than the energy of tearing. parting: speed; unit: m/s.
double calc_lasting(const TieState& tie, double length, double parting, double inverse_mass,
                    double step) {
  const double slack = std::max(0.0, tie.length - length);
  if (!(parting > 0) || slack >= parting * step) return 1;
  const double time = step - slack / parting;
  const double slower = parting - tie.strength * inverse_mass * time;
  if (slower <= 0) return 1;  // it stops them, or the next step sees to it
  const double way = (parting + slower) / 2 * time;
  return way > tie.stretch ? std::max(tie.stretch / way, 1e-3) : 1;
}

}  // namespace

// From the centre of mass of the body that a piece moves with; of the ground in the world.
Vec3f World::Impl::find_anchor(std::int32_t piece, const Vec3& anchor) const {
  if (piece == kGround) return Vec3f(anchor);
  const Body& own = data.bodies[piece];
  const Vec3 offset = own.lead >= 0 ? own.origin_in_group : -own.com_in_type;
  return Vec3f(acting(piece).world_from_com.rotation.rotate(offset + anchor));
}

// Its arms and normal where the bodies are now; returns the distance between its anchors.
double World::Impl::pose_tie(Tie& tie) const {
  Contact& c = tie.contact;
  ContactPoint& p = c.points[0];
  const Vec3 centre_a = data.bodies[c.body_a].world_from_com.translation;
  const Vec3 centre_b =
      c.body_b == kGround ? Vec3{} : data.bodies[c.body_b].world_from_com.translation;
  const Vec3 a = centre_a + Vec3(find_anchor(tie.state.piece_a, tie.state.anchor_a));
  const Vec3 b = centre_b + Vec3(find_anchor(tie.state.piece_b, tie.state.anchor_b));
  const double length = distance(a, b);
  // Both act in the middle of the bar: what holds it sideways gives no momentum to the pair.
  const Vec3 middle = (a + b) * 0.5;
  p.from_a = Vec3f(middle - centre_a), p.from_b = Vec3f(middle - centre_b);
  if (length > kShortest) c.normal = Vec3f((a - b) * (1 / length));
  p.separation = float(tie.state.length - length) + solver_settings.rest_gap;
  const float z = float(std::max(a.z, b.z));
  if (std::abs(z - tie.order) > kOrderDistance) tie.order = z;
  return length;
}

// Bars that are taut bend as the pieces turn against each other, and yield as they do: a moment
// brakes that turning. It is given before the solution, which then keeps the bars' lengths.
void World::Impl::bend_ties() {
  const float step = float(options.step);
  for (const Tie& tie : data.ties) {
    const Contact& c = tie.contact;
    if (!tie.solved || !(c.points[0].normal_impulse > 0) || !(tie.state.bending > 0)) continue;
    const Body& a = data.bodies[c.body_a];
    const bool a_moves = a.awake && a.simbody_index >= 0;
    const bool b_moves = c.body_b != kGround && data.bodies[c.body_b].awake &&
                         data.bodies[c.body_b].simbody_index >= 0;
    Vec3f turning, of_a, of_b;
    if (a_moves) turning += velocities[c.body_a].angular;
    if (b_moves) turning -= velocities[c.body_b].angular;
    const float speed = norm(turning);
    if (!(speed > 0)) continue;
    const Vec3f axis = turning * (1 / speed);
    if (a_moves) of_a = a.inverse_inertia * axis;
    if (b_moves) of_b = data.bodies[c.body_b].inverse_inertia * axis;
    const float gives = dot(axis, of_a + of_b);
    const float impulse = std::min(float(tie.state.bending) * step, speed / gives);
    if (a_moves) velocities[c.body_a].angular -= of_a * impulse;
    if (b_moves) velocities[c.body_b].angular += of_b * impulse;
  }
}

// Those that are taut, or may become so, go behind the contacts: what hangs is solved from above.
void World::Impl::begin_ties() {
  if (data.ties.empty()) return;
  const double step = options.step;
  std::vector<std::pair<float, std::int32_t>> order;
  const auto is_awake = [this](std::int32_t body) {
    return body != kGround && data.bodies[body].awake;
  };
  const auto lead_of = [this](std::int32_t piece) {
    return piece == kGround               ? kGround
           : data.bodies[piece].lead >= 0 ? data.bodies[piece].lead
                                          : piece;
  };
  for (std::size_t i = 0; i < data.ties.size(); ++i) {
    Tie& tie = data.ties[i];
    Contact& c = tie.contact;
    tie.solved = false;
    c.body_a = lead_of(tie.state.piece_a), c.body_b = lead_of(tie.state.piece_b);
    const bool same = c.body_a == c.body_b;
    if (!same && !is_awake(c.body_a) && !is_awake(c.body_b)) continue;  // carries what it did
    bool near = false;
    double lasts = 1;
    if (!same) {
      const double length = pose_tie(tie);
      const Body& a = data.bodies[c.body_a];
      double inverse_mass = double(a.awake ? a.inverse_mass : 0);
      Vec3f speed = a.linear + cross(a.angular, c.points[0].from_a);
      if (c.body_b != kGround) {
        const Body& b = data.bodies[c.body_b];
        speed -= b.linear + cross(b.angular, c.points[0].from_b);
        inverse_mass += double(b.awake ? b.inverse_mass : 0);
      }
      const double parting = kSteps * step * (norm(Vec3(speed)) + options.gravity * step);
      near = length > kShortest && length + parting + kSlack > tie.state.length;
      lasts = calc_lasting(tie.state, length, double(dot(c.normal, speed)), inverse_mass, step);
    }
    if (!near) {
      c.pressed = c.highest = c.points[0].normal_impulse = 0;
      continue;
    }
    tie.solved = true;
    c.most = float(tie.state.strength * step / solver_settings.substeps * lasts);
    order.push_back({-tie.order, std::int32_t(i)});
  }
  bend_ties();
  std::sort(order.begin(), order.end());
  for (const auto& [height, i] : order) {
    active.push_back(std::int32_t(data.contacts.size()));
    data.contacts.push_back(std::move(data.ties[i].contact));
    tie_order.push_back(i);
  }
}

// Back to where they are kept: behind the pairs nothing stays.
void World::Impl::end_ties() {
  active.resize(active.size() - tie_order.size());
  const std::size_t first = data.pairs.size();
  for (std::size_t k = 0; k < tie_order.size(); ++k) {
    data.ties[tie_order[k]].contact = std::move(data.contacts[first + k]);
  }
  data.contacts.resize(first);
  tie_order.clear();
}

// Bodies that are deep in each other, the lower number first, sorted.
std::vector<std::pair<std::int32_t, std::int32_t>> World::Impl::find_pressed_deep() const {
  std::vector<std::pair<std::int32_t, std::int32_t>> deep;
  for (const std::int32_t i : active) {
    const Contact& c = data.contacts[i];
    for (int k = 0; k < c.count; ++k) {
      if (c.points[k].separation < -kSpallingDepth) {
        deep.push_back(std::minmax(c.body_a, c.body_b));
        break;
      }
    }
  }
  std::sort(deep.begin(), deep.end());
  return deep;
}

// What yielded is longer by as much as its anchors are now too far apart, and tears when nothing is
// left. So does what contacts hold apart: it must not press pieces into each other.
void World::Impl::stretch_ties() {
  if (data.ties.empty()) return;
  const auto deep = find_pressed_deep();
  for (Tie& tie : data.ties) {
    if (!tie.solved || !(tie.contact.pressed > 0)) continue;
    const bool yields = tie.contact.highest >= kYields * tie.contact.most;
    double longer = pose_tie(tie) - tie.state.length - (yields ? 0 : kMostError);
    const std::pair<std::int32_t, std::int32_t> bodies = std::minmax(tie.contact.body_a, tie.contact.body_b);
    if (std::binary_search(deep.begin(), deep.end(), bodies)) longer = std::max(longer, kSpalls);
    if (!(longer > 0)) continue;
    tie.state.length += longer;
    if (yields) data.tie_energy += tie.state.strength * std::min(longer, tie.state.stretch);
    tie.state.stretch -= longer;
    if (tie.state.stretch < 0) note_lost_contact(tie.contact);
  }
  const auto torn = [](const Tie& tie) { return tie.state.stretch < 0; };
  data.ties.erase(std::remove_if(data.ties.begin(), data.ties.end(), torn), data.ties.end());
}

void World::Impl::lose_ties() {
  const auto is_lost = [this](std::int32_t piece) {
    return piece != kGround && acting(piece).lost;
  };
  const auto gone = [&](const Tie& tie) {
    return is_lost(tie.state.piece_a) || is_lost(tie.state.piece_b);
  };
  data.ties.erase(std::remove_if(data.ties.begin(), data.ties.end(), gone), data.ties.end());
}

void World::Impl::add_tie(const TieState& state) {
  const int count = int(data.bodies.size());
  const auto refuse = [](const char* key, const std::string& expected, double found) {
    throw InputError(
        {"", 0, std::string("tie.") + key, "out of range", expected, std::to_string(found), ""});
  };
  const auto is_piece = [&](std::int32_t i) {
    return i >= 0 && i < count && data.bodies[i].tree < 0;
  };
  if (!is_piece(state.piece_a)) refuse("piece_a", "a piece that is no link", state.piece_a);
  if (state.piece_b != kGround && (!is_piece(state.piece_b) || state.piece_b == state.piece_a)) {
    refuse("piece_b", "another piece that is no link, or -1", state.piece_b);
  }
  if (!(state.length > 0 && state.length < 1e3)) refuse("length", "0 to 1000 m", state.length);
  if (!(state.strength > 0)) refuse("strength", "more than 0 N", state.strength);
  if (!(state.stretch >= 0)) refuse("stretch", "0 m or more", state.stretch);
  if (!(state.bending >= 0)) refuse("bending", "0 N m or more", state.bending);
  Tie tie;
  tie.state = state;
  tie.contact.count = 1;
  tie.contact.has_normal = true;
  tie.contact.friction = state.bending > 0 ? kSideways : 0.0F;
  tie.contact.points.make();
  data.ties.push_back(std::move(tie));
}

void World::add_tie(const TieState& tie) { impl_->add_tie(tie); }

std::vector<TieState> World::ties() const {
  std::vector<TieState> result;
  for (const Tie& tie : impl_->data.ties) result.push_back(tie.state);
  return result;
}

int World::tie_count() const { return int(impl_->data.ties.size()); }

double World::tie_energy() const { return impl_->data.tie_energy; }

double World::tie_force(int index) const {
  return double(impl_->data.ties[std::size_t(index)].contact.pressed) / impl_->options.step;
}

}  // namespace rubble
