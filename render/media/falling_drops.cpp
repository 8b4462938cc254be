#include "render/media/falling_drops.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {

namespace {

constexpr double kClassRatio = 1.3;     // of the diameters at its ends
constexpr std::size_t kPerJob = 20000;  // drops

// Poisson's distribution: by products of uniforms (Knuth), and for large means by its normal limit.
std::size_t draw_count(double mean, RandomStream& random) {
  if (mean > 100) return std::size_t(std::max(0.0, std::floor(mean + std::sqrt(mean) * random.normal() + 0.5)));
  std::size_t count = 0;
  for (double product = random.uniform(), least = quick::exp(-mean); product > least; product *= random.uniform()) ++count;
  return count;
}

double wrap(double x, double side) { return x - side * std::floor(x / side + 0.5); }  // from -side/2 to side/2

}  // namespace

FallingDrops::FallingDrops(const Precipitation& precipitation, const Vec3& wind, std::uint64_t seed)
    : precipitation_(precipitation), wind_(wind) {
  const bool rain = precipitation.kind() == PrecipitationKind::rain;
  const double last = precipitation.largest();
  for (double low = precipitation.smallest(); low < last; low *= kClassRatio) {
    RandomStream random(seed, (rain ? "air.rain." : "air.snow.") + std::to_string(classes_.size()));
    const double high = std::min(low * kClassRatio, last);
    Class one;
    one.side = 2 * precipitation.reach(high);
    one.drops.resize(draw_count(precipitation.count(low, high) * one.side * one.side * one.side, random));
    for (Seed& drop : one.drops) {
      for (int i = 0; i < 3; ++i) drop.place[i] = float(random.uniform() * one.side);
      drop.diameter = float(precipitation.draw(low, high, random.uniform()));
    }
    classes_.push_back(std::move(one));
  }
}

std::vector<Drop> FallingDrops::about(const Vec3& eye, const Vec3& facing, double cosine, double nearest,
                                      double seconds, int threads) const {
  std::vector<Drop> out;
  for (const Class& one : classes_) {
    std::vector<std::vector<Drop>> found((one.drops.size() + kPerJob - 1) / kPerJob);
    parallel_for(found.size(), threads, [&](std::size_t job) {
      const std::size_t end = std::min(one.drops.size(), (job + 1) * kPerJob);
      for (std::size_t i = job * kPerJob; i < end; ++i) {
        const Seed& seed = one.drops[i];
        const double melted = double(seed.diameter);
        const Vec3 velocity = wind_ - Vec3(0, 0, precipitation_.fall_speed(melted));
        Vec3 away = Vec3(seed.place) + velocity * seconds - eye;
        for (int k = 0; k < 3; ++k) away[k] = wrap(away[k], one.side);
        const double distance = norm(away);
        if (distance > precipitation_.reach(melted) || distance < nearest) continue;
        if (dot(away, facing) < cosine * distance) continue;
        found[job].push_back({eye + away, velocity, 1e-3 * precipitation_.diameter(melted)});
      }
    });
    for (const std::vector<Drop>& part : found) out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace rubble
