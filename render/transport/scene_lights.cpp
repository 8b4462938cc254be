#include "render/transport/scene_lights.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr float kSunCosine = 1 - kSunSolidAngle / (2 * portable::kPiF);  // of the disc's radius

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}
Vec3f mix(const Vec3f& a, const Vec3f& b, float t) { return a + (b - a) * t; }

void make_basis(const Vec3f& z, Vec3f& x, Vec3f& y) {
  const Vec3f side = std::fabs(z.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
  x = normalized(cross(side, z));
  y = cross(z, x);
}

// Within the cone about `axis` whose edge has this cosine, evenly.
Vec3f within_cone(const Vec3f& axis, float cosine, SamplePair u) {
  Vec3f x, y;
  make_basis(axis, x, y);
  const float off = u.x * (1 - cosine);  // one minus the cosine
  const float sine = std::sqrt(std::max(0.0f, off * (2 - off))), turn = 2 * portable::kPiF * u.y;
  return normalized(axis * (1 - off) + x * (sine * quick::cos(turn)) + y * (sine * quick::sin(turn)));
}

}  // namespace

PlacedLamp place_lamp(const LampSpec& lamp, const Vec3f& colour, const Pose& world_from_camera) {
  PlacedLamp out;
  out.position = Vec3f(world_from_camera * lamp.position);
  out.axis = Vec3f(world_from_camera.rotation.rotate({1, 0, 0}));
  out.side = Vec3f(world_from_camera.rotation.rotate({0, 1, 0}));
  out.up = Vec3f(world_from_camera.rotation.rotate({0, 0, 1}));
  if (lamp.on) out.intensity = colour;
  out.cone = float(1 / (1 - portable::cos(0.5 * lamp.cone_deg * portable::kPi / 180)));
  out.radius = lamp.shape == LampShape::point ? 0 : float(lamp.size / 2);
  out.disc = lamp.shape == LampShape::cluster;
  return out;
}

Vec3f PlacedLamp::diode(SamplePair u) const {
  if (radius <= 0) return position;
  const float r = radius * (disc ? std::sqrt(u.x) : 1), turn = 2 * portable::kPiF * u.y;
  return position + side * (r * quick::cos(turn)) + up * (r * quick::sin(turn));
}

// Falls to half at the half-power angle h: I = I0 2^-((1 - cos a) / (1 - cos h))^2.
Vec3f PlacedLamp::illuminance(const Vec3f& diode, const Vec3f& point) const {
  const Vec3f way = point - diode;
  const float d2 = std::max(dot(way, way), 1e-6f);
  const float x = (1 - dot(way, axis) / std::sqrt(d2)) * cone;
  return intensity * (quick::exp2(-x * x) / d2);
}

SceneLights::SceneLights(const LightSet& lights) : lights_(lights), sky_sampler_(lights.sky) {
  const LightModel& main = lights.lights.front();
  const bool sunny = main.type == LightType::directional;
  skyline_ = lights.sky.mean * 0.10f + (sunny ? main.colour * 0.02f : Vec3f());
  lights_.carried = 0;  // here all are alike
  lights_.lights.insert(lights_.lights.end(), lights.far.begin(), lights.far.end());
}

bool SceneLights::located(std::size_t light) const {
  return light >= lights_.lights.size() || lights_.lights[light].type != LightType::directional;
}

Vec3f SceneLights::place(std::size_t light, const PlacedLamp& lamp, SamplePair u) const {
  return light < lights_.lights.size() ? lights_.lights[light].position : lamp.diode(u);
}

Vec3f SceneLights::illuminance_from(std::size_t light, const PlacedLamp& lamp, const Vec3f& place,
                                    const Vec3f& point) const {
  if (light >= lights_.lights.size()) return lamp.illuminance(place, point);
  return lights_.lights[light].at(point).illuminance;
}

SceneLights::Arrival SceneLights::arrive(std::size_t light, const PlacedLamp& lamp,
                                         const Vec3f& point, SamplePair u) const {
  if (located(light)) {
    const Vec3f from = place(light, lamp, u);
    const float distance = std::max(norm(from - point), 1e-3f);
    return {(from - point) * (1 / distance), illuminance_from(light, lamp, from, point), distance};
  }
  const LightModel& beam = lights_.lights[light];
  const Vec3f to_light = light == 0 ? within_cone(-beam.axis, kSunCosine, u) : -beam.axis;
  return {to_light, beam.colour, kFarAway};
}

Vec3f SceneLights::backdrop(const Vec3f& d) const {
  Vec3f sky = lights_.sky.radiance({d.x, d.y, std::max(d.z, 0.0f)});
  sky += lights_.sky.sun_radiance * smoothstep(0.999985f, 0.999992f, dot(d, lights_.sky.sun_direction));
  const Vec3f a = normalized(Vec3f(d.x, d.y, 0));
  const float ridge = 0.017f + 0.006f * quick::sin(5.3f * a.x + 2.0f * quick::sin(3.1f * a.y)) +
                      0.004f * quick::sin(11.0f * a.y + 1.7f) +
                      0.0025f * quick::sin(37.0f * a.x + 4.0f * quick::sin(19.0f * a.y)) +
                      0.0016f * quick::sin(120.0f * a.y - 70.0f * a.x) * quick::sin(83.0f * a.x) +
                      0.0008f * quick::sin(310.0f * a.x + 230.0f * a.y);
  const float behind = smoothstep(ridge - 0.0008f, ridge + 0.0008f, d.z);
  return mix(mix(skyline_, sky, std::min(0.55f + 10.0f * std::max(d.z, 0.0f), 1.0f)), sky, behind);
}

}  // namespace rubble
