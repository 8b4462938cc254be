#include "render/view/drop_drawer.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/media/streaks.h"
#include "render/view/air_lamp.h"

namespace rubble {

namespace {

constexpr double kNearest = 0.15;  // within it, the camera's housing keeps drops away; our choice; unit: m
constexpr double kShelter = 100;   // how far above a drop a roof counts; unit: m

// Of the widest angle from the axis at which the image sees something; -1: behind it, too.
double widest_cosine(const ViewRays& view) {
  const Intrinsics& k = view.intrinsics;
  const Lens lens(k);
  double least = 1;
  for (const double u : {-0.5, k.width - 0.5})
    for (const double v : {-0.5, k.height - 0.5}) {
      const auto direction = lens.direction(u, v);
      if (!direction) return -1;
      least = std::min(least, direction->z);
    }
  return k.lens == LensModel::fisheye ? -1 : least - 0.02;
}

bool beside(const Streak& s, const Intrinsics& k) {
  const double reach = std::max({s.width, s.blur, 1.0});
  return std::max(s.u0, s.u1) < -reach || std::min(s.u0, s.u1) > k.width + reach || std::max(s.v0, s.v1) < -reach ||
         std::min(s.v0, s.v1) > k.height + reach;
}

}  // namespace

void DropDrawer::restart() { falling_.clear(), rays_.reset(); }

void DropDrawer::prepare() {
  if (rays_) return rays_->follow();
  for (const Precipitation& kind : scene_.medium.falling())
    falling_.emplace_back(kind, scene_.medium.wind(), scene_.seed);
  rays_ = std::make_unique<RayScene>(scene_.scene);
}

bool DropDrawer::sheltered(const Drop& drop, double seconds) const {
  return rays_->blocked(Vec3f(drop.place + drop.velocity * seconds), Vec3f(normalized(drop.velocity * -1.0)), 0, kShelter);
}

Vec3f DropDrawer::radiance_of(const Drop& drop, const Vec3& direction, const AirLamp& lamp) const {
  const Scatterer drops{0, 0, 1};
  const Vec3f p(drop.place), away(direction);
  Vec3f sum = even_glow(scene_.air_light(), scene_.light, drops, p) + lamp_glow(lamp, drops, p, away, 0);
  for (const LightModel& model : scene_.light.lights) {
    const LightModel::Sample light = model.at(p);
    if (light.illuminance == Vec3f() ||
        rays_->blocked(p, light.to_light, 0, std::min(light.distance * 0.999f, kLightReach)))
      continue;
    sum += light.illuminance * drops.phase(double(dot(light.to_light, away)));
  }
  return sum;
}

void DropDrawer::add(const ExposedView& exposed, std::vector<float>& radiance) {
  if (scene_.medium.falling().empty()) return;
  const ViewRays& view = exposed.middle;
  const Intrinsics& k = view.intrinsics;
  scene_.move_to(view.stamp_ns);
  prepare();
  const AirLamp lamp = glow_of(scene_.frame_light.lamp, view.lamp_bearer());
  const Lens lens(k);
  const Pose world_from_optical = view.world_from_camera * camera_from_optical;
  const Vec3 eye = world_from_optical.translation, facing = world_from_optical.rotation.rotate({0, 0, 1});
  const double cosine = widest_cosine(view), seconds = double(view.stamp_ns - scene_.start_ns) * 1e-9;
  const int threads = std::max(1, scene_.options.threads);
  std::vector<Streak> streaks;
  for (const FallingDrops& kind : falling_) {
    const std::vector<Drop> drops = kind.about(eye, facing, cosine, kNearest, seconds, threads);
    std::vector<Streak> placed(drops.size());
    parallel_for(drops.size(), threads, [&](std::size_t i) {
      const Drop& drop = drops[i];
      Streak& streak = placed[i];
      streak.distance = distance(drop.place, eye);
      const double z = dot(drop.place - eye, facing);
      streak.width = drop.diameter * k.fx / streak.distance;
      if (exposed.focus > 0 && z > 0) streak.blur = k.fx * exposed.aperture * std::fabs(1 / exposed.focus - 1 / z);
      if (!place_streak(lens, exposed.open, exposed.close, exposed.seconds, drop, streak) || beside(streak, k) ||
          sheltered(drop, 0.5 * exposed.seconds))
        streak.width = 0;
      else
        streak.radiance = radiance_of(drop, (drop.place - eye) * (1 / streak.distance), lamp);
    });
    for (const Streak& streak : placed)
      if (streak.width > 0) streaks.push_back(streak);
  }
  draw_streaks(streaks, exposed.distances, k.width, k.height, threads, radiance);
}

}  // namespace rubble
