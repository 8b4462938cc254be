#include "render/view/lit_scene.h"

#include <algorithm>

#include "kernel/base/system/disk_cache.h"
#include "render/colour/frame_fill.h"
#include "render/materials/surface_appearance.h"
#include "render/media/air_box.h"
#include "render/reference/image_key.h"
#include "render/transport/drawn_albedo.h"

namespace rubble {

namespace {

// A lamp is drowned where its light so far ahead of it is less than this share of daylight.
constexpr double kGlowDistance = 2;  // unit: m
constexpr double kDrowned = 0.02;    // unit: 1
constexpr float kOpen = 0.25f;       // share of free directions about a lamp that daylight may hide; unit: 1

float most_gloss(const PreparedScene& scene) {
  float most = 0;
  for (const PreparedMesh& mesh : scene.meshes)
    for (const PreparedTriangle& t : mesh.triangles)
      most = std::max(most, mirrored_peak(all_surface_appearances()[t.material].reflectance,
                                          all_surface_appearances()[t.material].roughness));
  if (!scene.paints) return most;
  for (const PaintLayers::Paint& paint : scene.paints->paints) {
    const float roughness = paint.relief >= 0 ? 0.0f : paint.roughness;
    most = std::max(most, mirrored_peak(paint.metalness > 0 ? 1.0f : paint.reflectance,
                                        std::max(roughness * roughness, 0.02f)));
  }
  return most;
}

bool shines(const PreparedScene& scene) {
  for (const PreparedMesh& mesh : scene.meshes)
    for (const PreparedTriangle& t : mesh.triangles)
      if (all_surface_appearances()[t.material].glow > 0) return true;
  return false;
}

}  // namespace

LitScene::RestingPart::RestingPart(const PreparedScene& whole, SceneRays& whole_rays, bool moves)
    : own(moves ? resting_part(whole) : PreparedScene()),
      own_rays(own),
      scene(moves ? own : whole),
      rays(moves ? own_rays : whole_rays) {
  for (std::uint32_t i = 0; i < whole.placed.size(); ++i) {
    const bool rests = !whole.placed[i].moves;
    in_part.push_back(rests ? std::uint32_t(in_whole.size()) : kNone);
    if (rests) in_whole.push_back(i);
  }
}

LitScene::LitScene(Device& d, const Scene& s, const RenderOptions& o,
                   const std::function<void(double)>& progress)
    : device(d),
      options(o),
      pool(std::max(1, o.threads)),
      scene(prepare_scene(s, o.threads)),
      rays(scene),
      ground_map(make_ground_map(scene)),
      patterns(make_patterns_once(DiskCache(o.cache_folder), o.texture_size, o.threads)),
      moving(s, scene),
      light(make_lights(s)),
      resting_light(light.without_carried()),
      medium(s.air, s.seed),
      start_ns(s.start_ns),
      seed(s.seed),
      carried_lights_(s.carried_lights) {
  progress(0.05);
  bake(s.wetness, [&](double f) { progress(0.05 + 0.9 * f); });
  LightTable whole;
  if (moving.any()) {
    whole.resize(scene.light_nodes);
    for (const std::uint32_t piece : lit_pieces()) {
      const std::uint32_t first = resting_->scene.placed[resting_->in_part[piece]].first_light;
      std::copy_n(resting_nodes().begin() + first, scene.meshes[scene.placed[piece].mesh].light_nodes.size(),
                  whole.begin() + scene.placed[piece].first_light);
    }
  }
  on_device = device.load(scene, light, moving.any() ? whole : resting_nodes(),
                          {o.shadow_size, !is_traced(), o.instruction_set}, pool);
  if (moving.any()) {
    const LookSurfaces surfaces(scene, patterns, ground_map, s.wetness);
    live_light = std::make_unique<LiveLight>(scene, resting_light, std::move(whole), drawn_albedo(surfaces), o.threads);
    on_device->move();  // carried lights, and nothing else yet
  }
  frame_light = {&light, is_traced() ? nullptr : &on_device->shadows(), s.lamp, medium.clear(), s.wetness, most_gloss(scene), shines(scene), scene.surrounded};
  frame_light.soft_sun = options.colour.quality != RenderQuality::draft;
  frame_light.glass = scene.glass;
  frame_light.nodes = &clear_nodes();
  air_changed_ = !medium.clear();
  progress(1);
}

// What rests. Of a still scene that is all of it.
void LitScene::bake(double wetness, const std::function<void(double)>& progress) {
  resting_ = std::make_unique<RestingPart>(scene, rays, moving.any());
  const PreparedScene& part = resting_->scene;
  if (!options.bake || is_traced()) {
    open_sky_ = open_sky_light(part, resting_light);
    return;
  }
  BakeOptions bake;
  bake.threads = options.threads;
  bake.rays = options.bake_rays;
  bake.seed = seed;
  const LookSurfaces surfaces(part, patterns, ground_map, wetness);
  bake_ = std::make_unique<LightBake>(part, resting_->rays, resting_light, drawn_albedo(surfaces), bake,
                                      DiskCache(options.cache_folder),
                                      surroundings_key({part, resting_light, patterns, ground_map, wetness}), progress);
}

// Of the whole: what rests and has its light.
std::vector<std::uint32_t> LitScene::lit_pieces() const {
  std::vector<std::uint32_t> out;
  for (std::uint32_t part = 0; part < resting_->in_whole.size(); ++part)
    if (!bake_ || bake_->knows(part)) out.push_back(resting_->in_whole[part]);
  return out;
}

void LitScene::light_pieces(const std::optional<std::vector<std::uint32_t>>& pieces) {
  if (knows_all_light()) return;
  std::vector<std::uint32_t> wanted;
  if (pieces)
    for (const std::uint32_t piece : *pieces)
      if (resting_->in_part[piece] != RestingPart::kNone) wanted.push_back(resting_->in_part[piece]);
  std::vector<std::uint32_t> found = pieces ? bake_->light_pieces(wanted) : bake_->light_all();
  if (found.empty()) return;
  std::vector<LightRange> changed;
  for (std::uint32_t& piece : found) {
    const std::uint32_t first = resting_->scene.placed[piece].first_light;
    piece = resting_->in_whole[piece];
    if (live_light) live_light->set_resting(piece, resting_nodes().data() + first);
    const PlacedMesh& placed = scene.placed[piece];
    changed.push_back({placed.first_light, placed.first_light + scene.meshes[placed.mesh].light_nodes.size()});
  }
  if (FogLight* fog = fog_light()) fog->weaken(scene, clear_nodes(), found, weakened_nodes_);
  if (lamp_bounce_) lamp_bounce_->change_base(nodes(), light_version_, changed);
  on_device->set_light(*frame_light.nodes, &changed);
}

void LitScene::move_to(std::int64_t stamp_ns) {
  if (!moving.move_to(stamp_ns)) return;
  place_carried_lights();
  on_device->move();
  if (is_traced()) return;  // the path tracer follows the scene itself
  live_light->update();
  surfaces_changed_ = true;
}

void LitScene::light_air(std::int64_t stamp_ns) {
  if (is_traced() || (!air_changed_ && !surfaces_changed_)) return;
  const bool draft = options.colour.quality == RenderQuality::draft;
  if (!draft && !medium.clear() && !fog_light_ && bake_) {
    FogLight::Radiance radiance;
    radiance.reserve(bake_->radiance().size());
    for (const Vec3f& r : bake_->radiance()) radiance.push_back({AirTransfer::Four{r.x, r.y, r.z, 0}});
    fog_light_ = std::make_unique<FogLight>(resting_->scene, resting_->rays.solid(), air_box(scene.bounds), resting_light,
                                            std::move(radiance), pool);
  }
  if (FogLight* fog = fog_light()) {
    if (air_changed_) fog->set_air(air_at(stamp_ns));
    std::vector<std::uint32_t> lit = lit_pieces();
    for (std::uint32_t piece = 0; piece < scene.placed.size(); ++piece)
      if (scene.placed[piece].moves) lit.push_back(piece);
    weakened_nodes_.resize(scene.light_nodes);
    fog->weaken(scene, clear_nodes(), lit, weakened_nodes_);
  }
  air_changed_ = surfaces_changed_ = false;
  ++light_version_;
  show_light(nodes());
}

void LitScene::show_light(const LightTable& shown, const std::vector<LightRange>* changed) {
  frame_light.nodes = &shown;
  on_device->set_light(shown, changed);
}

// What is not there does not shine.
void LitScene::place_carried_lights() {
  for (std::size_t i = 0; i < carried_lights_.size(); ++i) {
    const PlacedMesh& body = scene.placed[carried_lights_[i].instance];
    LightModel& model = light.lights[light.first_carried() + i];
    model = place_light(carried_lights_[i], body.world_from_mesh);
    if (!body.there) model.colour = {};
  }
}

void LitScene::aim_at(const PlacedLamp& lamp, float extinction) {
  if (!lamp_reach_) {
    std::vector<std::uint32_t> first_point;
    std::vector<std::uint8_t> counted;
    std::uint32_t next = 0;
    for (const PlacedMesh& piece : scene.placed) {
      first_point.push_back(piece.moves ? LampBounce::kNoPoints : next);
      if (!piece.moves) next += std::uint32_t(scene.meshes[piece.mesh].bake_points.size());
      counted.push_back(!piece.moves);
    }
    lamp_reach_ = std::make_unique<LampReach>(scene, rays, std::move(counted), pool);
    device_lamp_ = on_device->lamp(bake_->links(), first_point);
    if (!device_lamp_) lamp_bounce_ = std::make_unique<LampBounce>(scene, bake_->links(), first_point, pool);
  }
  lamp_reach_->aim(lamp, extinction);
  if (lamp_bounce_) lamp_bounce_->set_lamp(*lamp_reach_);
}

bool LitScene::aim_lamp(const Pose& bearer, std::int64_t stamp_ns) {
  const LampSpec& lamp = frame_light.lamp;
  const bool lit = lamp.on && lamp.intensity_cd > 0 && bake_;
  FogLight* fog = fog_light();
  lamp_fog_ = nullptr;
  if (lit) {
    const PlacedLamp placed = place_lamp(lamp, lamp_colour(lamp), bearer);
    const Air air = air_at(stamp_ns);
    const Vec3 place(placed.position);
    const double turned = in_box(air_box(scene.bounds), place) ? air.turned_share(air.fog_asymmetry()) : 1;
    aim_at(placed, air.clear() ? 0 : float(air.extinction(place) * turned));
    // By day nobody sees what air scatters twice of a lamp: finding it takes a third of the time of an image.
    const double glow = lamp.intensity_cd * 1e-3 / (kGlowDistance * kGlowDistance);
    if (fog && glow >= kDrowned * fog->daylight(placed.position)) lamp_fog_ = fog;
  }
  if (fog && !lamp_fog_) fog->put_lamp_out();
  return lit;
}

// A device is not asked: it would have to be waited for.
bool LitScene::bounce_shows(float exposure) const {
  return device_lamp_ || lamp_fog_ || light_shows(frame_light, lamp_bounce_->most_radiance(), exposure);
}

bool LitScene::lamp_is_in_the_open() const { return lamp_bounce_ && !lamp_fog_ && lamp_reach_->open_share() > kOpen; }

void LitScene::add_bounce(const std::function<std::vector<LampBounce::Shown>()>& shown) {
  if (device_lamp_) {
    const LampAir air = lamp_fog_ ? lamp_fog_->air_of_device() : LampAir();
    return device_lamp_->light(lamp_reach_->aim_of_device(), lamp_fog_ ? &air : nullptr);
  }
  // What was shown before is these nodes, or what was lit the time before.
  show_light(lamp_bounce_->add_to(nodes(), light_version_, shown(), lamp_fog_), &lamp_bounce_->changed());
  lit_by_lamp_ = true;
}

void LitScene::leave_bounce_out() {
  if (device_lamp_) return device_lamp_->put_out();
  if (lit_by_lamp_) show_light(nodes(), &lamp_bounce_->changed());
  lit_by_lamp_ = false;
}

Air LitScene::air_at(std::int64_t stamp_ns) const {
  return medium.at(double(stamp_ns - start_ns) * 1e-9);
}

void LitScene::change(const LampSpec& lamp, const AirSpec& air) {
  medium = Medium(air, seed);
  air_changed_ = true;
  frame_light.lamp = lamp;
  frame_light.clear_air = medium.clear();
}

}  // namespace rubble
