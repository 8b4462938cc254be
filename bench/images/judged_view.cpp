#include "bench/images/judged_view.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/scene/build_scene.h"
#include "bench/images/gallery_piles.h"
#include "bench/images/sky_panorama.h"
#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/image/exr_file.h"
#include "io/scenes/pile_export.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/colour/frame_light.h"

namespace rubble {

namespace {

using Json = nlohmann::ordered_json;

constexpr float kFarthest = 12;    // from here on clean air veils what is seen; unit: m
constexpr int kSkyHeight = 1024;   // of the panorama: 0.18 degrees a pixel

Json list_of(const Vec3f& v) { return {v.x, v.y, v.z}; }
Json list_of(const Vec3& v) { return {v.x, v.y, v.z}; }

void check_shared(const Scenario& scenario, const LightSet& lights) {
  const bool one = lights.lights.size() == 1 && lights.far.empty();
  if (!one || lights.lights.front().type != LightType::directional)
    throw RunError("a judged view has one light, the sun, and the lamp of the camera");
  const AirSpec& air = scenario.air;
  if (air.fog_density > 0 || air.dust.period > 0 || air.rain_mm_h > 0 || air.snow_mm_h > 0)
    throw RunError("a judged view has clear air");
  const Intrinsics lens = scenario.cameras.front().camera.intrinsics();
  if (lens.lens != LensModel::plumb_bob || lens.distortion != std::array<double, 5>{})
    throw RunError("a judged view has the lens of a pinhole");
  if (scenario.surroundings.on() || scenario.fines.amount > 0)
    throw RunError("a judged view has pieces and the ground alone");
}

Json camera_of(const ViewRays& view) {
  const Intrinsics& k = view.intrinsics;
  const Quat& turn = view.world_from_camera.rotation;
  return {{"width", k.width}, {"height", k.height}, {"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy},
          {"position", list_of(view.world_from_camera.translation)},
          {"forward", list_of(turn.rotate({1, 0, 0}))},
          {"left", list_of(turn.rotate({0, 1, 0}))},
          {"up", list_of(turn.rotate({0, 0, 1}))}};
}

Json sun_of(const LightModel& beam) {
  const double cosine = 1 - double(kSunSolidAngle) / (2 * portable::kPi);
  return {{"to_sun", list_of(-beam.axis)},
          {"illuminance", list_of(beam.colour)},
          {"angular_radius", portable::acos(cosine)}};
}

Json lamp_of(const PlacedLamp& lamp) {
  return {{"position", list_of(lamp.position)}, {"axis", list_of(lamp.axis)}, {"side", list_of(lamp.side)},
          {"up", list_of(lamp.up)},             {"intensity", list_of(lamp.intensity)},
          {"cone", lamp.cone},                  {"radius", lamp.radius}, {"disc", lamp.disc}};
}

Json mirror_of(double roughness) { return {{"roughness", roughness}, {"grey", kMirrorGrey}}; }

}  // namespace

JudgedView::JudgedView(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                       const JudgeOptions& options)
    : options_(options), model_(build_pile_model(assets, pile)) {
  strengthen_colours(model_, options.colour);
  const Scene scene = build_scene(scenario, assets, pile);
  lights_ = make_lights(scene);
  check_shared(scenario, lights_);
  scene_ = prepare_scene(scene, options.threads);
  view_.rays = view_of(scenario, options.size);
  view_.lamps = {place_lamp(scene.lamp, lamp_colour(scene.lamp), view_.rays.lamp_bearer())};
}

TracedImage JudgedView::trace() const {
  const RayScene rays(scene_, RayScene::Detail::finest);
  const PlainSurfaces surfaces(scene_, model_, options_.mirror);
  const SceneLights lights(lights_);
  const AirPath air;
  TraceOptions trace;
  trace.samples = options_.samples, trace.seed = 1;
  const PathTracer tracer({rays, surfaces, lights, air}, trace);
  TracedImage image = trace_image(tracer, view_, options_.samples, {32, options_.threads});
  const float cover = *std::min_element(image.cover.begin(), image.cover.end());
  const float farthest = *std::max_element(image.distance.begin(), image.distance.end());
  if (cover < 1 || farthest > kFarthest)
    throw RunError("a judged view shows surfaces within 12 m alone; the farthest is " +
                   std::to_string(farthest) + " m away, and of some pixel they cover " +
                   std::to_string(cover));
  return image;
}

void JudgedView::write(const std::string& folder, const std::string& name, const TracedImage& image,
                       double seconds) const {
  const std::string path = folder + "/" + name;
  write_glb(path + ".glb", model_);
  const SkyPanorama sky = make_sky_panorama(lights_.sky, kSkyHeight);
  write_text_file(path + "_sky.exr", encode_exr(sky.width, sky.height, {"R", "G", "B"}, sky.rgb));
  write_text_file(path + "_ours.pfm", encode_pfm(image.width, image.height, image.light));
  const LightModel& main = lights_.lights.front();
  const PreparedMesh& ground = scene_.meshes[scene_.placed.back().mesh];
  const Vec3f low = ground.vertices.front().position, high = ground.vertices.back().position;
  const Json json{{"name", name},
                  {"samples", options_.samples},
                  {"bounces", TraceOptions().most_bounces},
                  {"seconds", seconds},
                  {"mesh", name + ".glb"},
                  {"sky", name + "_sky.exr"},
                  {"ours", name + "_ours.pfm"},
                  {"camera", camera_of(view_.rays)},
                  {"sun", main.axis.z < 0 ? sun_of(main) : Json()},
                  {"lamp", view_.lamps.front().intensity == Vec3f() ? Json() : lamp_of(view_.lamps.front())},
                  {"mirror", options_.mirror > 0 ? mirror_of(options_.mirror) : Json()},
                  {"ground", {{"low", {low.x, low.y}}, {"high", {high.x, high.y}},
                              {"colour", list_of(model_.colour_of("ground"))}}}};
  write_text_file(path + ".json", json.dump(2) + "\n");
}

std::string encode_pfm(int width, int height, const std::vector<Vec3f>& values) {
  std::string out = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const Vec3f& v = values[std::size_t(y) * std::size_t(width) + std::size_t(x)];
      put(out, v.x), put(out, v.y), put(out, v.z);
    }
  }
  return out;
}

}  // namespace rubble
