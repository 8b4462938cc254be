#include "kernel/world/phases/ties.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"

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
double calc_lasting(const TieState& tie, double length, double parting, double inverse_mass, double step) {
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
Vec3f Ties::find_anchor(std::int32_t piece, const Vec3& anchor) const {
  if (piece == kGround) return Vec3f(anchor);
  const Body& own = data_.bodies[piece];
  const Vec3 offset = own.lead >= 0 ? own.origin_in_group : -own.com_in_type;
  return Vec3f(bodies_.acting(piece).world_from_com.rotation.rotate(offset + anchor));
}

// Its arms and normal where the bodies are now; returns the distance between its anchors.
double Ties::pose(Tie& tie) const {
  Contact& c = tie.contact;
  ContactPoint& p = c.points[0];
  const Vec3 centre_a = data_.bodies[c.body_a].world_from_com.translation;
  const Vec3 centre_b = c.body_b == kGround ? Vec3{} : data_.bodies[c.body_b].world_from_com.translation;
  const Vec3 a = centre_a + Vec3(find_anchor(tie.state.piece_a, tie.state.anchor_a));
  const Vec3 b = centre_b + Vec3(find_anchor(tie.state.piece_b, tie.state.anchor_b));
  const double length = distance(a, b);
  // Both act in the middle of the bar: what holds it sideways gives no momentum to the pair.
  const Vec3 middle = (a + b) * 0.5;
  p.from_a = Vec3f(middle - centre_a), p.from_b = Vec3f(middle - centre_b);
  if (length > kShortest) c.normal = Vec3f((a - b) * (1 / length));
  p.separation = float(tie.state.length - length) + settings_.solver.rest_gap;
  const float z = float(std::max(a.z, b.z));
  if (std::abs(z - tie.order) > kOrderDistance) tie.order = z;
  return length;
}

// Bars that are taut bend as the pieces turn against each other, and yield as they do: a moment
// brakes that turning. It is given before the solution, which then keeps the bars' lengths.
void Ties::bend(std::vector<Motion>& velocities) const {
  const float duration = float(settings_.options.step);
  for (const Tie& tie : data_.ties) {
    const Contact& c = tie.contact;
    if (!tie.solved || !(c.points[0].normal_impulse > 0) || !(tie.state.bending > 0)) continue;
    const Body& a = data_.bodies[c.body_a];
    const bool a_moves = a.awake && a.free_index >= 0;
    const bool b_moves =
        c.body_b != kGround && data_.bodies[c.body_b].awake && data_.bodies[c.body_b].free_index >= 0;
    Vec3f turning, of_a, of_b;
    if (a_moves) turning += velocities[c.body_a].angular;
    if (b_moves) turning -= velocities[c.body_b].angular;
    const float speed = norm(turning);
    if (!(speed > 0)) continue;
    const Vec3f axis = turning * (1 / speed);
    if (a_moves) of_a = a.inverse_inertia * axis;
    if (b_moves) of_b = data_.bodies[c.body_b].inverse_inertia * axis;
    const float gives = dot(axis, of_a + of_b);
    const float impulse = std::min(float(tie.state.bending) * duration, speed / gives);
    if (a_moves) velocities[c.body_a].angular -= of_a * impulse;
    if (b_moves) velocities[c.body_b].angular += of_b * impulse;
  }
}

void Ties::begin(StepPairs& step, std::vector<Motion>& velocities) {
  if (data_.ties.empty()) return;
  const double duration = settings_.options.step;
  std::vector<std::pair<float, std::int32_t>> order;
  const auto is_awake = [this](std::int32_t body) { return body != kGround && data_.bodies[body].awake; };
  const auto lead_of = [this](std::int32_t piece) {
    return piece == kGround ? kGround : data_.bodies[piece].lead >= 0 ? data_.bodies[piece].lead : piece;
  };
  for (std::size_t i = 0; i < data_.ties.size(); ++i) {
    Tie& tie = data_.ties[i];
    Contact& c = tie.contact;
    tie.solved = false;
    c.body_a = lead_of(tie.state.piece_a), c.body_b = lead_of(tie.state.piece_b);
    const bool same = c.body_a == c.body_b;
    if (!same && !is_awake(c.body_a) && !is_awake(c.body_b)) continue;  // carries what it did
    bool near = false;
    double lasts = 1;
    if (!same) {
      const double length = pose(tie);
      const Body& a = data_.bodies[c.body_a];
      double inverse_mass = double(a.awake ? a.inverse_mass : 0);
      Vec3f speed = a.linear + cross(a.angular, c.points[0].from_a);
      if (c.body_b != kGround) {
        const Body& b = data_.bodies[c.body_b];
        speed -= b.linear + cross(b.angular, c.points[0].from_b);
        inverse_mass += double(b.awake ? b.inverse_mass : 0);
      }
      const double parting = kSteps * duration * (norm(Vec3(speed)) + settings_.options.gravity * duration);
      near = length > kShortest && length + parting + kSlack > tie.state.length;
      lasts = calc_lasting(tie.state, length, double(dot(c.normal, speed)), inverse_mass, duration);
    }
    if (!near) {
      c.pressed = c.highest = c.points[0].normal_impulse = 0;
      continue;
    }
    tie.solved = true;
    c.most = float(tie.state.strength * duration / settings_.solver.substeps * lasts);
    order.push_back({-tie.order, std::int32_t(i)});
  }
  bend(velocities);
  std::sort(order.begin(), order.end());
  for (const auto& [height, i] : order) {
    step.active.push_back(std::int32_t(data_.contacts.size()));
    data_.contacts.push_back(std::move(data_.ties[i].contact));
    order_.push_back(i);
  }
}

void Ties::end(StepPairs& step) {
  step.active.resize(step.active.size() - order_.size());
  const std::size_t first = data_.pairs.size();
  for (std::size_t k = 0; k < order_.size(); ++k) {
    data_.ties[order_[k]].contact = std::move(data_.contacts[first + k]);
  }
  data_.contacts.resize(first);
  order_.clear();
}

// Bodies that are deep in each other, the lower number first, sorted.
std::vector<std::pair<std::int32_t, std::int32_t>> Ties::find_pressed_deep(const StepPairs& step) const {
  std::vector<std::pair<std::int32_t, std::int32_t>> deep;
  for (const std::int32_t i : step.active) {
    const Contact& c = data_.contacts[i];
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

void Ties::stretch(const StepPairs& step) {
  if (data_.ties.empty()) return;
  const auto deep = find_pressed_deep(step);
  for (Tie& tie : data_.ties) {
    if (!tie.solved || !(tie.contact.pressed > 0)) continue;
    const bool yields = tie.contact.highest >= kYields * tie.contact.most;
    double longer = pose(tie) - tie.state.length - (yields ? 0 : kMostError);
    const std::pair<std::int32_t, std::int32_t> bodies = std::minmax(tie.contact.body_a, tie.contact.body_b);
    if (std::binary_search(deep.begin(), deep.end(), bodies)) longer = std::max(longer, kSpalls);
    if (!(longer > 0)) continue;
    tie.state.length += longer;
    if (yields) data_.tie_energy += tie.state.strength * std::min(longer, tie.state.stretch);
    tie.state.stretch -= longer;
    if (tie.state.stretch < 0) waking_.note_lost_contact(tie.contact);
  }
  const auto torn = [](const Tie& tie) { return tie.state.stretch < 0; };
  data_.ties.erase(std::remove_if(data_.ties.begin(), data_.ties.end(), torn), data_.ties.end());
}

void Ties::drop_lost() {
  const auto is_lost = [this](std::int32_t piece) { return piece != kGround && bodies_.acting(piece).lost; };
  const auto gone = [&](const Tie& tie) { return is_lost(tie.state.piece_a) || is_lost(tie.state.piece_b); };
  data_.ties.erase(std::remove_if(data_.ties.begin(), data_.ties.end(), gone), data_.ties.end());
}

void Ties::add(const TieState& state) {
  const int count = int(data_.bodies.size());
  const auto refuse = [](const char* key, const std::string& expected, double found) {
    throw InputError({"", 0, std::string("tie.") + key, "out of range", expected, plain_text(found), ""});
  };
  const auto is_piece = [&](std::int32_t i) { return i >= 0 && i < count && data_.bodies[i].tree < 0; };
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
  data_.ties.push_back(std::move(tie));
}

}  // namespace rubble
