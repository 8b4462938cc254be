#include "kernel/model/track_builder.h"

#include <algorithm>
#include <cassert>

namespace rubble {

void TrackBuilder::begin_sample(double time) {
  assert(track_.times.empty() || time > track_.times.back());
  track_.times.push_back(time);
}

TrackBody& TrackBuilder::find_or_add(const BodySample& sample) {
  auto& bodies = track_.bodies;
  const auto at = std::lower_bound(bodies.begin(), bodies.end(), sample.id,
                                   [](const TrackBody& b, std::int32_t id) { return b.id < id; });
  if (at != bodies.end() && at->id == sample.id) return *at;
  TrackBody body;
  body.id = sample.id;
  body.centre = sample.centre;
  return *bodies.insert(at, body);
}

void TrackBuilder::set(const BodySample& sample) {
  assert(!track_.times.empty());
  const auto now = std::uint32_t(track_.times.size() - 1);
  TrackBody& body = find_or_add(sample);
  if (!body.keys.empty()) {
    const TrackKey last = body.keys.back();
    assert(last.sample < now && body.gone == TrackBody::kStays);
    if (last.world_from_body == sample.world_from_body) return;
    // It rested until the sample before this one.
    if (last.sample + 1 < now) body.keys.push_back({now - 1, last.world_from_body, {}, {}});
  }
  body.keys.push_back({now, sample.world_from_body, Vec3f(sample.linear_velocity),
                       Vec3f(sample.angular_velocity)});
}

void TrackBuilder::remove(std::int32_t id) {
  for (TrackBody& body : track_.bodies)
    if (body.id == id && body.gone == TrackBody::kStays)
      body.gone = std::uint32_t(track_.times.size() - 1);
}

void TrackBuilder::forget_from(double time) {
  auto& times = track_.times;
  const auto kept = std::uint32_t(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  times.resize(kept);
  for (TrackBody& body : track_.bodies) {
    while (!body.keys.empty() && body.keys.back().sample >= kept) body.keys.pop_back();
    if (body.gone >= kept) body.gone = TrackBody::kStays;
  }
  auto& bodies = track_.bodies;
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(),
                              [](const TrackBody& body) { return body.keys.empty(); }),
               bodies.end());
}

}  // namespace rubble
