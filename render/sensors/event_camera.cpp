#include "render/sensors/event_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kernel/base/quick_math.h"
#include "render/sensors/noise_field.h"

namespace rubble {

namespace {

constexpr double kLeastThreshold = 0.01;

}  // namespace

EventPixels::EventPixels(const EventCameraSpec& spec, int width, int height, std::uint64_t seed)
    : spec_(spec), width_(width), seed_(seed) {
  const std::size_t size = std::size_t(width) * std::size_t(height);
  const NoiseField noise(seed, "events/thresholds");
  up_.resize(size), down_.resize(size);
  silent_until_ns_.assign(size, std::numeric_limits<std::int64_t>::min());
  for (std::size_t i = 0; i < size; ++i) {
    const auto threshold = [&](double stated, std::size_t place) {
      return float(std::max(kLeastThreshold, stated + spec.threshold_noise * noise.normal(place)));
    };
    up_[i] = threshold(spec.threshold_up, i * 2);
    down_[i] = threshold(spec.threshold_down, i * 2 + 1);
  }
}

void EventPixels::cross(std::size_t pixel, std::int64_t from_ns, std::int64_t to_ns, double from,
                        double to, double& reference, std::vector<Event>& events) {
  if (from == to) return;
  const bool brighter = to > from;
  const double step = brighter ? double(up_[pixel]) : -double(down_[pixel]);
  while (brighter ? reference + step <= to : reference + step >= to) {
    reference += step;
    // A reference beyond `from` was passed earlier, in the other direction.
    const double share = std::clamp((reference - from) / (to - from), 0.0, 1.0);
    const std::int64_t stamp = from_ns + std::llround(share * double(to_ns - from_ns));
    if (stamp < silent_until_ns_[pixel]) continue;
    silent_until_ns_[pixel] = stamp + std::llround(spec_.refractory * 1e9);
    events.push_back({stamp, std::uint16_t(pixel % std::size_t(width_)),
                      std::uint16_t(pixel / std::size_t(width_)), brighter});
  }
}

void EventPixels::add_noise(std::int64_t from_ns, std::int64_t to_ns, std::vector<Event>& events) {
  const double expected = spec_.background_hz * double(to_ns - from_ns) * 1e-9;
  if (!(expected > 0)) return;
  const NoiseField count(seed_, "events/count", images_), more(seed_, "events/noise", images_);
  constexpr std::size_t kBlock = 64;  // of one pixel's events, between those of its neighbours
  for (std::size_t i = 0; i < up_.size(); ++i) {
    const auto n = std::size_t(count.poisson(i, expected));
    for (std::size_t e = 0; e < n; ++e) {
      const std::size_t place = ((e / kBlock * up_.size() + i) * kBlock + e % kBlock) * 2;
      const auto after = std::int64_t(more.uniform(place) * double(to_ns - from_ns));
      events.push_back({from_ns + 1 + after, std::uint16_t(i % std::size_t(width_)),
                        std::uint16_t(i / std::size_t(width_)), more.uniform(place + 1) < 0.5});
    }
  }
}

void EventPixels::see(std::int64_t stamp_ns, const std::vector<float>& light,
                      std::vector<Event>& events) {
  std::vector<double> level(light.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    level[i] = quick::log(std::max(0.0, double(light[i])) + spec_.dark);
  const std::size_t first = events.size();
  if (images_ == 0) reference_ = level_ = level;
  for (std::size_t i = 0; i < level.size(); ++i)
    cross(i, last_ns_, stamp_ns, level_[i], level[i], reference_[i], events);
  level_ = std::move(level);
  end_image(stamp_ns, first, events);
}

void EventPixels::see_changes(std::int64_t stamp_ns, const std::vector<LightChange>& changes, std::vector<Event>& events) {
  const std::size_t first = events.size();
  for (const LightChange& change : changes) {
    double reference = change.reference;
    cross(change.pixel, last_ns_, stamp_ns, change.from, change.to, reference, events);
  }
  end_image(stamp_ns, first, events);
}

void EventPixels::end_image(std::int64_t stamp_ns, std::size_t first, std::vector<Event>& events) {
  if (images_ > 0) add_noise(last_ns_, stamp_ns, events);
  std::sort(events.begin() + std::ptrdiff_t(first), events.end(), [](const Event& a, const Event& b) {
    return std::tie(a.stamp_ns, a.y, a.x, a.brighter) < std::tie(b.stamp_ns, b.y, b.x, b.brighter);
  });
  last_ns_ = stamp_ns;
  ++images_;
}

WatchedPixels EventPixels::pixels() const {
  return {width_, int(up_.size() / std::size_t(width_)), up_, down_, float(spec_.dark)};
}

}  // namespace rubble
