#include "kernel/collision/way_out.h"

#include <algorithm>

namespace rubble {
namespace {

// Directions closer than 6 degrees are the same one.
constexpr float kSameWayCosine = 0.995F;
// The direction of the step before counts as this much shorter.
constexpr float kKeptShare = 0.7F;
// Moved out, parts are this much farther apart than they need be; unit: m.
constexpr float kWayClearance = 0.001F;
// At most this many directions are tried out; the others are longer.
constexpr int kTried = 6;

struct Candidate {
  Vec3f direction;
  float depth = 0;  // unit: m
  float rank = 0;   // depth, less for the direction of the step before
};

struct Box {
  Vec3f min, max;
};

Box calc_box(const PosedPart& part) {
  Box box{part.corners.points[0], part.corners.points[0]};
  for (int i = 1; i < part.corners.count; ++i) {
    const Vec3f& p = part.corners.points[i];
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

std::vector<Box> calc_boxes(const std::vector<PosedPart>& parts) {
  std::vector<Box> boxes;
  for (const PosedPart& part : parts) boxes.push_back(calc_box(part));
  return boxes;
}

bool meet(const Box& a, const Box& b, const Vec3f& offset) {
  return a.min.x <= b.max.x + offset.x && b.min.x + offset.x <= a.max.x &&
         a.min.y <= b.max.y + offset.y && b.min.y + offset.y <= a.max.y &&
         a.min.z <= b.max.z + offset.z && b.min.z + offset.z <= a.max.z;
}

// Whether no parts of the two pieces overlap.
class Clearance {
 public:
  Clearance(const std::vector<PosedPart>& a, const std::vector<PosedPart>& b)
      : a_(a), b_(b), boxes_a_(calc_boxes(a)), boxes_b_(calc_boxes(b)) {}

  bool is_clear(const Vec3f& offset) const {
    for (std::size_t i = 0; i < a_.size(); ++i) {
      for (std::size_t j = 0; j < b_.size(); ++j) {
        if (!meet(boxes_a_[i], boxes_b_[j], offset)) continue;
        GjkCache cache;
        const GjkResult r = calc_distance(a_[i].corners, b_[j].corners, offset, 0, cache);
        if (r.kind == GjkResult::Kind::overlapping) return false;
      }
    }
    return true;
  }

 private:
  const std::vector<PosedPart>&a_, &b_;
  std::vector<Box> boxes_a_, boxes_b_;
};

class WayCandidates {
 public:
  WayCandidates(const std::vector<OverlappingParts>& overlapping, const Vec3f& offset)
      : overlapping_(overlapping), offset_(offset) {}

  void offer(const Vec3f& direction, float preference) {
    for (const Candidate& c : all_) {
      if (dot(c.direction, direction) > kSameWayCosine) return;
    }
    Candidate c{direction, 0, 0};
    for (const OverlappingParts& o : overlapping_) {
      c.depth = std::max(c.depth, calc_depth_along(o.a, o.b, offset_, direction));
    }
    c.rank = c.depth * preference;
    all_.push_back(c);
  }

  void offer_faces(const PosedPart& part, float sign) {
    for (int f = 0; f < int(part.shape->faces.size()); ++f) offer(part.face_normal(f) * sign, 1);
  }

  std::vector<Candidate>& sorted() {
    std::stable_sort(all_.begin(), all_.end(),
                     [](const Candidate& p, const Candidate& q) { return p.rank < q.rank; });
    return all_;
  }

 private:
  const std::vector<OverlappingParts>& overlapping_;
  Vec3f offset_;
  std::vector<Candidate> all_;
};

}  // namespace

float calc_depth_along(const PosedPart& a, const PosedPart& b, const Vec3f& offset,
                       const Vec3f& direction) {
  const Vec3f front = a.corners.points[find_support(a.corners, direction)];
  const Vec3f back = b.corners.points[find_support(b.corners, -direction)] + offset;
  return dot(direction, front - back);
}

Vec3f find_way_out(const std::vector<OverlappingParts>& overlapping,
                   const std::vector<PosedPart>& parts_a, const std::vector<PosedPart>& parts_b,
                   const Vec3f& offset, const Vec3f& before) {
  WayCandidates candidates(overlapping, offset);
  if (dot(before, before) > 0) candidates.offer(before, kKeptShare);
  for (const OverlappingParts& o : overlapping) candidates.offer(o.normal, 1);
  for (const OverlappingParts& o : overlapping) {
    candidates.offer_faces(o.a, 1);
    candidates.offer_faces(o.b, -1);
  }
  const std::vector<Candidate>& sorted = candidates.sorted();
  const Clearance clearance(parts_a, parts_b);
  for (int i = 0; i < std::min(kTried, int(sorted.size())); ++i) {
    const Candidate& c = sorted[std::size_t(i)];
    if (clearance.is_clear(offset + c.direction * (c.depth + kWayClearance))) return c.direction;
  }
  return sorted.front().direction;
}

}  // namespace rubble
