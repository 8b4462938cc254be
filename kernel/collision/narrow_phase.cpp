#include "kernel/collision/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernel/collision/manifold.h"
#include "kernel/collision/rolling.h"
#include "kernel/collision/way_out.h"

namespace rubble {
namespace {

// Points of two steps count as the same point if they are closer than this; unit: m.
constexpr float kMatchDistance = 0.01F;
// Impulses are kept for the next step only if the normal has turned by less than 25 degrees.
constexpr float kKeepCosine = 0.906F;
// To find their axis, overlapping parts are shifted apart along the last normal by this, and by 4 times this;
// unit: m.
constexpr float kShift = 0.005F;
// Clipped points may be this much farther apart than the distance along the axis; unit: m.
constexpr float kAxisTolerance = 0.0005F;
// An axis that is found for shifted parts counts only if it is within 26 degrees of the last normal.
constexpr float kNearestShiftCosine = 0.9F;
// A point of the previous step is retained while its two ends are not farther apart than this; unit: m.
constexpr float kRetainDistance = 0.004F;
// Contacts of pieces that move farther than this against each other in a step are searched where they will meet: levers
// that are taken at the step's start would change their angular momentum. Pieces of a pile that settles move less: what
// others push aside in the same step may meet elsewhere, or meet at all where it seemed to pass. unit: m
constexpr float kLongTravel = 0.2F;
// Pieces that are nearer to each other than this have met. unit: m
constexpr float kMeetingGap = 0.002F;
constexpr int kMostAdvances = 6;  // steps of the search for the time when two meet. unit: 1
// A point is retained only while the normal has turned by at most 8 degrees since the last search.
constexpr float kRetainCosine = 0.99F;

// An empty manifold of this thread, until the next call: to clear all of its points would take as long as to
// find those of a contact.
Manifold& begin_manifold() {
  thread_local Manifold manifold;
  manifold.count = 0;
  return manifold;
}

struct Axis {
  Vec3f normal;
  float separation = 0;
  Vec3f point;  // midway between the closest points
};

// True when the parts may touch in this step; fills the axis, else its separation alone.
bool find_axis(Contact& contact, const PosedPart& a, const PosedPart& b, const Vec3f& offset,
               float margin, Axis& axis) {
  GjkResult gjk = calc_distance(a.corners, b.corners, offset, margin, contact.cache);
  if (gjk.kind == GjkResult::Kind::beyond_margin) {
    contact.normal = gjk.normal;
    contact.has_normal = true;
    axis.separation = gjk.distance;
    return false;
  }
  if (gjk.kind == GjkResult::Kind::separated) {
    axis = {gjk.normal, gjk.distance, (gjk.point_a + gjk.point_b) * 0.5F};
    return true;
  }
  if (contact.has_normal) {
    for (float shift : {kShift, 4 * kShift}) {
      const Vec3f shifted = offset + contact.normal * shift;
      gjk = calc_distance(a.corners, b.corners, shifted, 1e30F, contact.cache);
      if (gjk.kind != GjkResult::Kind::separated) continue;
      const float cosine = dot(gjk.normal, contact.normal);
      if (cosine < kNearestShiftCosine) break;
      const float separation = gjk.distance - shift * cosine;
      axis = {gjk.normal, separation,
              (gjk.point_a + gjk.point_b - contact.normal * shift) * 0.5F};
      return true;
    }
  }
  const SatResult sat = find_separating_axis(a, b, offset);
  axis = {sat.normal, sat.separation, sat.point};
  return true;
}

// Edges that meet, or a corner that leads, are not on the faces that were clipped: the point that
// the axis was found at must be among the points.
void add_axis_point(Manifold& m, const Axis& axis) {
  float least = 1e30F;
  for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[i].separation);
  if (least > axis.separation + kAxisTolerance && m.count < Manifold::kMaxClipped) {
    m.points[m.count++] = {axis.point, axis.separation, axis.separation, -1};
  }
}

// Points of the step before that the search did not find again, where they are now. A search sees one
// pair of faces and one closest point: of two broken surfaces that rest on three chips, it finds another
// chip in each step, and without the others the piece rocks for ever.
void retain_points(const Contact& contact, const PosedBody& a, const PosedBody& b,
                   const Vec3f& offset, const Vec3f& normal, Manifold& m) {
  if (contact.count == 0 || dot(normal, contact.normal) < kRetainCosine) return;
  const int found = m.count;
  for (int i = 0; i < contact.count && m.count < Manifold::kMaxClipped; ++i) {
    const ContactPoint& p = contact.points[i];
    const Vec3f end_a = *a.part.rotation * p.local_a;
    const Vec3f end_b = *b.part.rotation * p.local_b + offset;
    const Vec3f apart = end_b - end_a;
    if (dot(apart, apart) > kRetainDistance * kRetainDistance) continue;
    const Vec3f position = (end_a + end_b) * 0.5F;
    const bool known = std::any_of(m.points, m.points + found, [&](const ManifoldPoint& q) {
      const Vec3f d = q.position - position;
      return dot(d, d) < kMatchDistance * kMatchDistance;
    });
    if (known) continue;
    const float separation = p.found_separation + dot(normal, apart);
    m.points[m.count++] = {position, separation, separation, i};
  }
}

void predict(Manifold& m, const PosedBody& a, const PosedBody* b, const Vec3f& offset,
             const Vec3f& normal, float step) {
  for (int i = 0; i < m.count; ++i) {
    Vec3f v = -(a.linear + cross(a.angular, m.points[i].position));
    if (b != nullptr) v += b->linear + cross(b->angular, m.points[i].position - offset);
    m.points[i].predicted = m.points[i].separation + step * dot(normal, v);
  }
}

// Leaves out points that cannot touch in this step: they would only cost time in the solver.
void drop_far_points(Manifold& m) {
  int kept = 0;
  for (int i = 0; i < m.count; ++i) {
    if (std::min(m.points[i].predicted, m.points[i].separation) < kPointMargin) {
      m.points[kept++] = m.points[i];
    }
  }
  m.count = kept;
}

// A corner runs on a circle: how much less than its speed says it comes down at most. unit: m
float calc_arc_gain(const Vec3f& p, const Vec3f& angular, float step) {
  const float spin2 = dot(angular, angular);
  if (!(spin2 > 0)) return 0;
  const float rise = cross(angular, p).z, high = p.z - angular.z * (dot(p, angular) / spin2);
  const float radius = std::sqrt(high * high + rise * rise / spin2);
  return std::max(0.0F, -radius - high - step * rise);
}

// All points where they fit, else the lowest predicted and an even choice of the others: those of a
// level face with many corners lie about equally low.
void keep_some(std::vector<ManifoldPoint>& found, Manifold& m) {
  constexpr int kLowest = Manifold::kMaxClipped / 2, kOthers = Manifold::kMaxClipped - kLowest;
  const int count = int(found.size());
  if (count <= Manifold::kMaxClipped) {
    m.count = count;
    std::copy(found.begin(), found.end(), m.points);
    return;
  }
  for (int i = 0; i < kOthers; ++i) m.points[m.count++] = found[std::size_t(i * count / kOthers)];
  std::stable_sort(found.begin(), found.end(), [](const ManifoldPoint& p, const ManifoldPoint& q) {
    return p.predicted < q.predicted;
  });
  for (int i = 0; i < kLowest; ++i) m.points[m.count++] = found[std::size_t(i)];
}

// Whether the contact had each point in the step before, as store() finds them again.
void note_known(const Contact& contact, const PosedBody& a, const PosedBody* b, const Vec3f& offset, const Vec3f& normal,
                Manifold& m) {
  if (m.count <= Contact::kMaxPoints || contact.count == 0 || dot(normal, contact.normal) <= kKeepCosine) return;
  const Mat3f a_from_world = a.part.rotation->transposed();
  const Mat3f b_from_world = b != nullptr ? b->part.rotation->transposed() : Mat3f::identity();
  for (int i = 0; i < m.count; ++i) {
    const Vec3f local_a = a_from_world * m.points[i].position, local_b = b_from_world * (m.points[i].position - offset);
    m.points[i].known = std::any_of(contact.points.begin(), contact.points.begin() + contact.count, [&](const ContactPoint& p) {
      const Vec3f da = p.local_a - local_a, db = p.local_b - local_b;
      return std::min(dot(da, da), dot(db, db)) < kMatchDistance * kMatchDistance;
    });
  }
}

// Writes the manifold into the contact and hands over impulses from the points found again.
void store(Contact& contact, const Manifold& m, const Vec3f& normal, const PosedBody& a,
           const PosedBody* b, const Vec3f& offset) {
  const bool keep = contact.count > 0 && dot(normal, contact.normal) > kKeepCosine;
  thread_local ContactPoint before[Contact::kMaxPoints];
  std::copy(contact.points.begin(), contact.points.begin() + contact.count, before);
  int old_count = keep ? contact.count : 0;
  int old[Contact::kMaxPoints];  // of `before`, not found again so far
  std::iota(old, old + old_count, 0);
  if (!keep) {
    contact.friction_impulse = {};
    contact.twist_impulse = 0;
  }
  contact.normal = normal;
  contact.has_normal = true;
  contact.count = m.count;
  if (m.count > 0) contact.points.make();
  const Mat3f a_from_world = a.part.rotation->transposed();
  const Mat3f b_from_world = b != nullptr ? b->part.rotation->transposed() : Mat3f::identity();
  for (int i = 0; i < m.count; ++i) {
    ContactPoint& p = contact.points[i];
    p.from_a = m.points[i].position;
    p.from_b = m.points[i].position - offset;
    p.local_a = a_from_world * p.from_a;
    p.local_b = b_from_world * p.from_b;
    p.separation = p.found_separation = m.points[i].separation;
    if (const int retained = m.points[i].retained; retained >= 0) {
      p.local_a = before[retained].local_a;
      p.local_b = before[retained].local_b;
      p.found_separation = before[retained].found_separation;
    }
    p.normal_impulse = 0;
    int match = -1;
    float best = kMatchDistance * kMatchDistance;
    for (int j = 0; j < old_count; ++j) {
      // A corner stays in one of the two frames when the pieces slide.
      const ContactPoint& q = before[old[j]];
      const Vec3f da = q.local_a - p.local_a, db = q.local_b - p.local_b;
      const float d2 = std::min(dot(da, da), dot(db, db));
      if (d2 < best) best = d2, match = j;
    }
    if (match < 0) continue;
    p.normal_impulse = before[old[match]].normal_impulse;
    old[match] = old[--old_count];
  }
}

// The points along an axis; none where the parts stay apart in this step. elapsed: where the two are as they will be
// after this part of the step. unit: s
void make_points(Contact& contact, const PosedBody& a, const PosedBody& b, const Vec3f& offset,
                 const Axis& axis, float margin, const NarrowSettings& settings, float elapsed = 0) {
  Manifold& m = begin_manifold();
  clip_faces(a.part, b.part, offset, axis.normal, margin, m);
  add_axis_point(m, axis);
  retain_points(contact, a, b, offset, axis.normal, m);
  contact.rolls_a = rolls(a, axis.normal, settings.step);
  contact.rolls_b = rolls(b, axis.normal, settings.step);
  if (contact.rolls_a) carry_below_axis(m, axis.normal, a.angular, {});
  if (contact.rolls_b) carry_below_axis(m, axis.normal, b.angular, offset);
  if (elapsed > 0) predict(m, a, &b, offset, axis.normal, -elapsed);
  for (int i = 0; i < m.count && elapsed > 0; ++i) m.points[i].separation = m.points[i].predicted;
  predict(m, a, &b, offset, axis.normal, settings.step);
  drop_far_points(m);
  if (m.count == 0) {
    contact.normal = axis.normal;
    contact.has_normal = true;
    return clear_points(contact);
  }
  note_known(contact, a, &b, offset, axis.normal, m);
  reduce(m, axis.normal, Contact::kMaxPoints);
  store(contact, m, axis.normal, a, &b, offset);
}

// A body as it will be after a part of the step.
class MovedBody {
 public:
  MovedBody(const PosedBody& body, float seconds) : moved(body) {
    const Vec3f half = body.angular * (0.5F * seconds);
    const Mat3f turned = normalized(QuatT<float>{1, half.x, half.y, half.z}).matrix();
    rotation_ = turned * *body.part.rotation;
    corners_.resize(std::size_t(body.part.corners.count));
    for (std::size_t i = 0; i < corners_.size(); ++i) corners_[i] = turned * body.part.corners.points[i];
    moved.part.corners.points = corners_.data();
    moved.part.rotation = &rotation_;
    moved.centre += Vec3(body.linear) * double(seconds);
  }
  MovedBody(const MovedBody&) = delete;
  MovedBody& operator=(const MovedBody&) = delete;

  PosedBody moved;

 private:
  Mat3f rotation_;
  std::vector<Vec3f> corners_;
};

float calc_reach(const PosedBody& body) {
  float squared = 0;
  for (int i = 0; i < body.part.corners.count; ++i) {
    squared = std::max(squared, dot(body.part.corners.points[i], body.part.corners.points[i]));
  }
  return std::sqrt(squared);
}

// When two that move against each other fast meet: conservative advancement (Mirtich 1996) of their translation. 0: they
// touch already, or are slow; kNoMeeting: they pass each other. unit: s
constexpr float kNoMeeting = -1;
float find_meeting(Contact& contact, const PosedBody& a, const PosedBody& b, const NarrowSettings& settings) {
  const Vec3f offset = Vec3f(b.centre - a.centre), v = b.linear - a.linear;
  const float travel = norm(v) * settings.step;
  if (travel < kLongTravel) return 0;
  const float turning = settings.step * (norm(a.angular) * calc_reach(a) + norm(b.angular) * calc_reach(b));
  float time = 0;
  for (int i = 0; i < kMostAdvances; ++i) {
    const float margin = travel + turning + kPointMargin;
    const GjkResult gjk = calc_distance(a.part.corners, b.part.corners, offset + v * time, margin, contact.cache);
    if (gjk.kind == GjkResult::Kind::beyond_margin) return 0;
    if (gjk.kind == GjkResult::Kind::overlapping) return time;
    const float closing = -dot(gjk.normal, v);
    if (gjk.distance > std::max(0.0F, closing) * (settings.step - time) + turning + kPointMargin) return kNoMeeting;
    if (gjk.distance < kMeetingGap || closing <= 0) return time;
    const float next = time + (gjk.distance - 0.5F * kMeetingGap) / closing;
    if (next >= settings.step) return time;
    time = next;
  }
  return time;
}

}  // namespace

float motion_margin(const Vec3f& relative, float turning, const NarrowSettings& settings) {
  return settings.margin + settings.step * (norm(relative) + turning);
}

void clear_points(Contact& contact) {
  contact.count = 0;
  contact.points.drop();
  contact.friction_impulse = {};
  contact.twist_impulse = 0;
  contact.pressed = 0;
}

void store_points(Contact& contact, Manifold& manifold, const Vec3f& normal, const PosedBody& a) {
  const Vec3f offset = Vec3f(-a.centre);
  note_known(contact, a, nullptr, offset, normal, manifold);
  reduce(manifold, normal, Contact::kMaxPoints);
  store(contact, manifold, normal, a, nullptr, offset);
}

void follow_contact(Contact& contact, const PosedBody& a, const PosedBody& b) {
  const Vec3f offset = Vec3f(b.centre - a.centre);
  contact.rolls_a = contact.rolls_b = false;
  for (int i = 0; i < contact.count; ++i) {
    ContactPoint& p = contact.points[i];
    const Vec3f end_a = *a.part.rotation * p.local_a;
    const Vec3f end_b = *b.part.rotation * p.local_b + offset;
    p.from_a = (end_a + end_b) * 0.5F;
    p.from_b = p.from_a - offset;
    p.separation = p.found_separation + dot(contact.normal, end_b - end_a);
  }
}

float update_contact(Contact& contact, const PosedBody& a, const PosedBody& b, float margin,
                     const NarrowSettings& settings, bool free) {
  const float meeting = free ? find_meeting(contact, a, b, settings) : 0;
  if (meeting == kNoMeeting) {
    clear_points(contact);
    return 0;
  }
  if (meeting > 0) {
    const MovedBody later_a(a, meeting), later_b(b, meeting);
    const Vec3f offset = Vec3f(later_b.moved.centre - later_a.moved.centre);
    Axis axis;
    if (find_axis(contact, later_a.moved.part, later_b.moved.part, offset, margin, axis)) {
      make_points(contact, later_a.moved, later_b.moved, offset, axis, margin, settings, meeting);
      return 0;
    }
  }
  const Vec3f offset = Vec3f(b.centre - a.centre);
  Axis axis;
  if (!find_axis(contact, a.part, b.part, offset, margin, axis)) {
    clear_points(contact);
    return axis.separation;
  }
  make_points(contact, a, b, offset, axis, margin, settings);
  return contact.count > 0 ? 0 : std::max(0.0F, axis.separation);
}

void search_along(Contact& contact, const PosedBody& a, const PosedBody& b, const Vec3f& normal,
                  float margin, const NarrowSettings& settings) {
  const Vec3f offset = Vec3f(b.centre - a.centre);
  const ContactPoint* deepest = std::min_element(
      contact.points.begin(), contact.points.begin() + contact.count,
      [](const ContactPoint& p, const ContactPoint& q) { return p.separation < q.separation; });
  const Axis axis{normal, -calc_depth_along(a.part, b.part, offset, normal), deepest->from_a};
  make_points(contact, a, b, offset, axis, margin, settings);
}

void update_ground_contact(Contact& contact, const PosedBody& a, float margin,
                           const NarrowSettings& settings) {
  const float height = float(a.centre.z);
  const Vec3f normal{0, 0, -1};
  contact.rolls_a = rolls(a, normal, settings.step);
  const Vec3f angular = contact.rolls_a ? Vec3f{} : a.angular;
  thread_local std::vector<ManifoldPoint> found;
  found.clear();
  for (int i = 0; i < a.part.corners.count; ++i) {
    const Vec3f& p = a.part.corners.points[i];
    const float s = height + p.z;
    if (s >= margin) continue;
    const float apart = s > 0 ? s + calc_arc_gain(p, angular, settings.step) : s;
    const float predicted = apart + settings.step * (a.linear + cross(angular, p)).z;
    if (std::min(predicted, apart) >= kPointMargin) continue;
    found.push_back({{p.x, p.y, p.z - 0.5F * s}, apart, predicted, -1});
  }
  if (found.empty()) return clear_points(contact);
  Manifold& m = begin_manifold();
  keep_some(found, m);
  if (contact.rolls_a) carry_below_axis(m, normal, a.angular, {});
  store_points(contact, m, normal, a);
}

}  // namespace rubble
