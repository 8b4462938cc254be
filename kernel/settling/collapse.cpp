#include "kernel/settling/collapse.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/structure/remaining_bars.h"

namespace rubble {
namespace {

constexpr double kImpactSpeed = 0.5;   // who meets faster brings energy; slower contacts are loads; unit: m/s
constexpr double kImpactTime = 0.004;  // concrete that strikes concrete: a step's mean force is less than the peak; unit: s
constexpr double kTogether = 0.3;      // bonds used up as much as the worst one, to this share, fail at once; unit: 1
constexpr double kRedistribution = 0.05;  // forces take so long to find new ways before more fails of itself; unit: s
constexpr int kBlastRounds = 40;       // of stresses that a blast's step may take; unit: 1
constexpr double kSameLoad = 0.3;      // changes below this share of a mean piece's weight are no news; unit: 1
constexpr double kCalmTime = 0.25;     // after which forces count as settled: a few periods of a floor; unit: s

Mat3 inverse_of(const Mat3& m) {
  const Vec3 c0 = cross(m.rows[1], m.rows[2]), c1 = cross(m.rows[2], m.rows[0]),
             c2 = cross(m.rows[0], m.rows[1]);
  return Mat3{{c0, c1, c2}}.transposed() * (1 / dot(m.rows[0], c0));
}

double quiet_sqrt(double x) { return x > 0 ? std::sqrt(x) : 0; }

}  // namespace

struct Collapse::Impl {
  // A body of several pieces.
  struct Part {
    std::unique_ptr<GroupStress> stress;
    double mass = 0;
    Vec3 centre;            // in the structure's frame
    Mat3 inertia;           // about it
    std::vector<PieceLoad> solved;   // loads of the last solution, by piece of the group; empty: none yet
    std::vector<SectionForces> forces;  // of it, by bond of the group
    int calm = 0;                    // steps without a failure
    int waits = 0;                   // steps until what failed has passed its forces on
  };
  struct Touch {
    Vec3 force, point;      // in the structure's frame
    double energy = 0;      // that an impact brings; unit: J
    int other = -1;
    bool impact = false;
  };

  World& world;
  Structure structure;
  CollapseOptions options;
  int first = 0;
  std::vector<BondStatus> status;
  std::vector<std::int32_t> lead_of;  // by piece
  std::map<std::int32_t, Part> parts;  // by lead; those with bonds
  std::vector<SectionForces> settled;
  Vec3 ground_acceleration;
  std::int32_t pushed = -1;  // the piece that a vehicle pushes
  Vec3 push_force, push_at;  // in the world; unit: N, m
  int push_steps = 0;        // to come
  bool sinks = false;        // a footing went down since the last solution
  std::map<std::int32_t, Vec3> blasted;  // impulse by piece; unit: N s
  std::vector<std::pair<int, double>> drained;  // pieces of the world, and the energy that breaking took
  CollapseReport report;
  bool breaking = true;  // in this step
  int arrests = 0;

  Impl(World& w, const Structure& s, int first_type, const CollapseOptions& o,
       std::vector<SectionForces> before)
      : world(w), structure(s), options(o), status(s.bonds.size()), settled(std::move(before)) {
    std::vector<NewPiece> pieces;
    for (const StructurePiece& piece : s.pieces) {
      NewPiece p;
      p.placement.type = first_type + piece.type;
      p.placement.world_from_body.translation = piece.position;
      p.placement.fixed = true;
      p.layer = -1;
      pieces.push_back(p);
    }
    first = world.add(pieces);
    lead_of.assign(pieces.size(), 0);
    world.bind(first, int(pieces.size()));
    report.bonds = int(s.bonds.size());
    // What nothing anchors from the start falls at once.
    replace(0, find_groups(structure, status), true);
  }

  void keep(const BondGroup& group) {
    for (const std::int32_t piece : group.pieces) lead_of[piece] = group.pieces[0];
    if (group.pieces.size() < 2 && !(group.anchored && !group.bonds.empty())) return;
    Part part;
    for (const std::int32_t i : group.pieces) {
      part.mass += structure.pieces[i].mass;
      part.centre += structure.pieces[i].centre * structure.pieces[i].mass;
    }
    part.centre *= 1 / part.mass;
    for (const std::int32_t i : group.pieces) {
      const StructurePiece& piece = structure.pieces[i];
      const Vec3 d = piece.centre - part.centre;
      part.inertia = part.inertia + piece.inertia;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          part.inertia.rows[r][c] += piece.mass * ((r == c ? dot(d, d) : 0.0) - d[r] * d[c]);
        }
      }
    }
    part.stress = std::make_unique<GroupStress>(structure, group);
    parts[group.pieces[0]] = std::move(part);
  }

  void replace(std::int32_t lead, const std::vector<BondGroup>& groups, bool always = false) {
    if (!always && groups.size() == 1 && groups[0].anchored == parts.at(lead).stress->group().anchored) return;
    parts.erase(lead);
    std::vector<SplitPart> split;
    for (const BondGroup& group : groups) {
      keep(group);
      SplitPart part;
      for (const std::int32_t piece : group.pieces) part.pieces.push_back(first + piece);
      part.fixed = group.anchored;
      split.push_back(std::move(part));
    }
    if (split.size() > 1 || !split[0].fixed) world.split(split);
  }

  // What touches the pieces of each body, by its lead.
  std::map<std::int32_t, std::vector<std::pair<std::int32_t, Touch>>> find_touches() const {
    std::map<std::int32_t, std::vector<std::pair<std::int32_t, Touch>>> touches;
    const int count = int(structure.pieces.size());
    for (const ContactImpulse& c : world.contact_impulses()) {
      const std::int32_t piece = c.piece - first;
      if (piece < 0 || piece >= count || !parts.count(lead_of[piece])) continue;
      const Pose pose = world.piece(c.piece).world_from_body;
      const Quat back = pose.rotation.conjugate();
      Touch touch;
      touch.point = structure.pieces[piece].position + back.rotate(c.point - pose.translation);
      touch.impact = c.approach > kImpactSpeed;
      touch.force = back.rotate(c.impulse) * (1 / (touch.impact ? kImpactTime : options.step));
      touch.energy = touch.impact ? 0.5 * norm(c.impulse) * c.approach : 0;
      touch.other = c.other;
      touches[lead_of[piece]].push_back({piece, touch});
    }
    return touches;
  }

  // The bars of what broke hold on.
  void tie(const std::vector<BondFailure>& failures) {
    for (const BondFailure& f : failures) {
      if (f.hinge || f.mode == FailureMode::compression) continue;  // crushed: its bars have buckled
      for (TieState t : find_remaining_bars(structure, structure.bonds[f.bond], options.continuity)) {
        t.piece_a += first;
        if (t.piece_b != kFoundation) t.piece_b += first;
        if (f.mode == FailureMode::shear) t.bending = 0;  // what slides is not held sideways
        world.add_tie(t);
        ++report.ties;
      }
    }
  }

  using Touches = std::vector<std::pair<std::int32_t, Touch>>;

  // Loads by piece of the structure; only those of the body are set.
  std::vector<PieceLoad> calc_loads(std::int32_t lead, const Part& part, const Touches& touches,
                                    bool with_impacts) const {
    const BondGroup& group = part.stress->group();
    std::vector<PieceLoad> loads(structure.pieces.size());
    const PieceState state = world.piece(first + lead);
    const Quat back = state.world_from_body.rotation.conjugate();
    const Vec3 pull = back.rotate(Vec3{0, 0, -options.gravity} - ground_acceleration);
    Vec3 force = pull * part.mass, torque;
    const auto push = [&](std::int32_t piece, const Vec3& f, const Vec3& point) {
      loads[piece].force += f;
      loads[piece].moment += cross(point - structure.pieces[piece].centre, f);
      force += f;
      torque += cross(point - part.centre, f);
    };
    for (const auto& [piece, touch] : touches) {
      if (with_impacts || !touch.impact) push(piece, touch.force, touch.point);
    }
    for (const auto& [piece, impulse] : blasted) {
      if (lead_of[piece] != lead || !with_impacts) continue;
      push(piece, back.rotate(impulse) * (1 / options.step), structure.pieces[piece].centre);
    }
    if (push_steps > 0 && lead_of[pushed] == lead) {
      const Pose pose = world.piece(first + pushed).world_from_body;
      push(pushed, back.rotate(push_force),
           structure.pieces[pushed].position + back.rotate(push_at - pose.translation));
    }
    if (group.anchored) {
      for (const std::int32_t i : group.pieces) loads[i].force += pull * structure.pieces[i].mass;
      return loads;
    }
    const Vec3 spin = back.rotate(state.angular_velocity);
    const Vec3 linear = force * (1 / part.mass);
    const Vec3 angular = inverse_of(part.inertia) * (torque - cross(spin, part.inertia * spin));
    for (const std::int32_t i : group.pieces) {
      const StructurePiece& piece = structure.pieces[i];
      const Vec3 r = piece.centre - part.centre;
      const Vec3 a = linear + cross(angular, r) + cross(spin, cross(spin, r));
      loads[i].force += (pull - a) * piece.mass;
      loads[i].moment -= piece.inertia * angular + cross(spin, piece.inertia * spin);
    }
    return loads;
  }

  bool is_news(const Part& part, const std::vector<PieceLoad>& loads) const {
    const BondGroup& group = part.stress->group();
    if (part.solved.empty() || (sinks && group.anchored)) return true;
    const double most = kSameLoad * part.mass * options.gravity / double(group.pieces.size());
    for (std::size_t i = 0; i < group.pieces.size(); ++i) {
      if (norm(loads[group.pieces[i]].force - part.solved[i].force) > most) return true;
    }
    return false;
  }

  FailureOptions failure_options(const BondGroup& group) const {
    FailureOptions f;
    f.together = kTogether;
    if (group.anchored && !settled.empty()) f.settled = &settled, f.overshoot = options.overshoot;
    return f;
  }

  StressResult solve(Part& part, const std::vector<PieceLoad>& loads) {
    const auto start = std::chrono::steady_clock::now();
    StressResult result = part.stress->solve(status, loads);
    report.stress_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++report.solutions;
    return result;
  }

  double breaking_energy(const std::vector<BondFailure>& failing) const {
    double sum = 0;
    for (const BondFailure& f : failing) sum += calc_breaking_energy(structure.bonds[f.bond].section);
    return sum;
  }

  // Whether an impact that would break these brings too little energy to do so; takes it otherwise.
  bool is_arrested(std::int32_t lead, Part& part, const Touches& touches,
                   const std::vector<BondFailure>& failing) {
    double energy = 0;
    for (const auto& touch : touches) energy += touch.second.energy;
    if (!(energy > 0)) return false;
    const BondGroup& group = part.stress->group();
    const StressResult at_rest = solve(part, calc_loads(lead, part, touches, false));
    if (!find_failing(structure, group, at_rest, failure_options(group), status).empty()) return false;
    const double taken = breaking_energy(failing);
    if (energy < taken) return ++arrests, true;
    for (const auto& touch : touches) {
      const Touch& t = touch.second;
      const double share = taken * t.energy / energy;
      if (group.anchored && t.other >= 0) drained.push_back({t.other, share});
      if (!group.anchored) drained.push_back({first + touch.first, share});
    }
    report.energy_taken += taken;
    return false;
  }

  // Whether the body came apart.
  bool update(std::int32_t lead, const Touches& touches) {
    Part& part = parts.at(lead);
    const BondGroup& group = part.stress->group();
    const bool blasts = std::any_of(blasted.begin(), blasted.end(),
                                    [&](const auto& b) { return lead_of[b.first] == lead; });
    if (!group.anchored && !blasts && (touches.empty() || !world.is_awake(first + lead))) return false;
    const bool impact = std::any_of(touches.begin(), touches.end(),
                                    [](const auto& t) { return t.second.impact; });
    if (part.waits > 0 && !impact && !blasts) return false;
    const std::vector<PieceLoad> loads = calc_loads(lead, part, touches, true);
    if (!is_news(part, loads)) return false;
    const StressResult result = solve(part, loads);
    part.solved.clear();
    for (const std::int32_t i : group.pieces) part.solved.push_back(loads[i]);
    part.forces = result.forces;
    const FailureOptions failure = failure_options(group);
    const std::vector<BondFailure> failing = find_failing(structure, group, result, failure, status);
    if (failing.empty() || is_arrested(lead, part, touches, failing)) return false;
    part.calm = 0;
    part.solved.clear();
    part.waits = int(kRedistribution / options.step);
    const int waits = part.waits;
    // One round: the next comes when contacts are solved again, or with the next step.
    bool broken = false;
    const std::vector<BondFailure> failed = fail_worst(structure, group, result, failure, status);
    for (const BondFailure& f : failed) {
      f.hinge ? ++report.hinges : ++report.broken;
      broken = broken || !f.hinge;
    }
    if (!broken) return false;
    tie(failed);
    std::vector<std::uint8_t> others(structure.pieces.size(), 1);
    for (const std::int32_t piece : group.pieces) others[piece] = 0;
    const std::size_t before = parts.size();
    const std::vector<BondGroup> groups = find_groups(structure, status, others);
    const bool apart = groups.size() > 1 || groups[0].anchored != group.anchored;
    replace(lead, groups);
    for (const BondGroup& left : groups) {
      const auto at = parts.find(left.pieces[0]);
      if (at != parts.end() && at->second.solved.empty()) at->second.waits = waits;
    }
    return apart || parts.size() != before;
  }

  // What a vehicle drives into, until it has come to a stop.
  void push_free() {
    if (push_steps <= 0) return;
    --push_steps;
    const int lead = first + lead_of[pushed];
    if (!is_free(lead)) return;
    set_motion(lead, push_force * (options.step / world.mass(lead)), world.piece(lead).angular_velocity);
  }

  // A blast is over within the step: all that it breaks breaks now, round by round.
  bool on_solved() {
    bool apart = update_all();
    for (int round = 0; round < kBlastRounds && !blasted.empty(); ++round) {
      const int before = report.broken + report.hinges;
      apart = update_all() || apart;
      if (report.broken + report.hinges == before) break;
    }
    return apart;
  }

  bool update_all() {
    const auto touches = find_touches();
    std::vector<std::int32_t> leads;
    for (const auto& part : parts) leads.push_back(part.first);
    bool apart = false;
    for (const std::int32_t lead : leads) {
      const auto found = touches.find(lead);
      apart = update(lead, found == touches.end() ? Touches{} : found->second) || apart;
    }
    return apart;
  }

  void settle_forces() {
    const int long_enough = int(kCalmTime / options.step);
    breaking = false;
    for (auto& [lead, part] : parts) {
      if (part.waits > 0) --part.waits, breaking = true;
      const BondGroup& group = part.stress->group();
      if (++part.calm != long_enough || settled.empty()) continue;
      if (part.forces.size() != group.bonds.size()) continue;
      for (std::size_t i = 0; i < group.bonds.size(); ++i) settled[group.bonds[i]] = part.forces[i];
    }
  }

  bool is_free(int piece) const { return world.piece(piece).status == PieceStatus::moving; }

  int lead_in_world(int piece) const {
    const int local = piece - first;
    return local >= 0 && local < int(lead_of.size()) ? first + lead_of[local] : piece;
  }

  void drain() {
    std::map<int, double> energy;
    for (const auto& [piece, taken] : drained) energy[lead_in_world(piece)] += taken;
    drained.clear();
    for (const auto& [piece, taken] : energy) {
      const double mass = world.mass(piece);
      const PieceState state = world.piece(piece);
      const double has = 0.5 * mass * dot(state.linear_velocity, state.linear_velocity);
      if (!is_free(piece) || !(has > 0)) continue;
      const double keep = quiet_sqrt(1 - taken / has);
      set_motion(piece, state.linear_velocity * keep - state.linear_velocity, state.angular_velocity * keep);
    }
  }

  // Adds to the speed of the whole body of a piece.
  void set_motion(int piece, const Vec3& gained, const Vec3& angular) {
    world.set_velocity(piece, world.centre_velocity(piece) + gained, angular);
  }

  void throw_blasted() {
    std::map<int, Vec3> impulses;
    for (const auto& [piece, impulse] : blasted) impulses[first + lead_of[piece]] += impulse;
    blasted.clear();
    for (const auto& [piece, impulse] : impulses) {
      if (is_free(piece)) {
        set_motion(piece, impulse * (1 / world.mass(piece)), world.piece(piece).angular_velocity);
      }
    }
  }

  // In the frame of the ground everything that is not held is accelerated against it.
  void accelerate() {
    if (dot(ground_acceleration, ground_acceleration) == 0) return;
    for (int i = 0; i < world.size(); ++i) {
      if (lead_in_world(i) != i || world.mass(i) <= 0) continue;
      set_motion(i, ground_acceleration * -options.step, world.piece(i).angular_velocity);
    }
  }
};

Collapse::Collapse(World& world, const Structure& structure, int first_type, const CollapseOptions& options,
                   std::vector<SectionForces> settled)
    : impl_(std::make_unique<Impl>(world, structure, first_type, options, std::move(settled))) {
  world.set_on_solved([this] { return impl_->on_solved(); });
}

Collapse::~Collapse() { impl_->world.set_on_solved({}); }

void Collapse::begin_step(const Vec3& ground_acceleration) {
  impl_->ground_acceleration = ground_acceleration;
  impl_->accelerate();
}

void Collapse::end_step() {
  impl_->drain();
  impl_->push_free();
  impl_->sinks = false;
  impl_->throw_blasted();
  impl_->settle_forces();
}

void Collapse::blast(const Vec3& at, double impulse_at_1m) {
  for (std::size_t i = 0; i < impl_->structure.pieces.size(); ++i) {
    const StructurePiece& piece = impl_->structure.pieces[i];
    const double density = impl_->structure.types[piece.type].density;
    const Vec3 away = piece.centre - at;
    const double r = std::max(1.0, norm(away)), volume = piece.mass / density;
    const double area = portable::exp(2.0 / 3.0 * portable::log(volume));
    impl_->blasted[std::int32_t(i)] = normalized(away) * (impulse_at_1m * area / (r * r));
  }
}

void Collapse::push(int member, const Vec3& at, const Vec3& force, double seconds) {
  Impl& c = *impl_;
  double nearest = 1e30;
  for (std::size_t i = 0; i < c.structure.pieces.size(); ++i) {
    const double away = distance(c.structure.pieces[i].centre, at);
    if (c.structure.pieces[i].member != member || away >= nearest) continue;
    c.pushed = std::int32_t(i);
    nearest = away;
  }
  c.push_at = at, c.push_force = force;
  c.push_steps = c.pushed < 0 ? 0 : std::max(1, int(seconds / c.options.step + 0.5));
}

void Collapse::sink(int member, const Vec3& by) {
  for (std::size_t i = 0; i < impl_->structure.bonds.size(); ++i) {
    const Bond& bond = impl_->structure.bonds[i];
    if (bond.piece_b != kFoundation || impl_->structure.pieces[bond.piece_a].member != member) continue;
    impl_->status[i].sunk = by;
    impl_->sinks = true;
  }
}

bool Collapse::is_breaking() const { return impl_->breaking || impl_->push_steps > 0; }
int Collapse::arrests() const { return impl_->arrests; }
int Collapse::first_piece() const { return impl_->first; }

CollapseReport Collapse::report() const {
  CollapseReport report = impl_->report;
  report.torn = report.ties - impl_->world.tie_count();
  report.tie_energy = impl_->world.tie_energy();
  return report;
}

std::vector<SectionForces> check_stands(const Structure& structure, double gravity) {
  std::vector<SectionForces> forces(structure.bonds.size());
  const std::vector<BondStatus> status(structure.bonds.size());
  BondFailure worst;
  const auto fail = [&](const std::string& message, const std::string& found) {
    throw InputError({"", 0, "pile.building", message, "a building that stands by itself", found,
                      "make members larger, spans shorter or bars stronger; causes come afterwards"});
  };
  for (const BondGroup& group : find_groups(structure, status)) {
    if (!group.anchored) {
      fail("a part of the building hangs in the air",
           structure.members[structure.pieces[group.pieces[0]].member].name);
    }
    GroupStress stress(structure, group);
    const StressResult result = stress.solve(status, calc_weights(structure, gravity));
    for (std::size_t i = 0; i < group.bonds.size(); ++i) forces[group.bonds[i]] = result.forces[i];
    const BondFailure most = find_worst(structure, group, result, status);
    if (most.utilization > worst.utilization) worst = most;
  }
  if (worst.utilization > 1) {
    char times[32];
    std::snprintf(times, sizeof times, "%.2f", worst.utilization);
    fail("the building does not stand before its cause: a bond fails by " +
             std::string(failure_name(worst.mode)),
         describe_bond(structure, worst.bond) + ", loaded to " + times + " times its strength");
  }
  return forces;
}

}  // namespace rubble
