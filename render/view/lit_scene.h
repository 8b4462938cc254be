// A scene on a device, lit: all that does not depend on the camera. Internal to render/.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "render/device/device.h"
#include "render/geometry/geometry.h"
#include "render/geometry/ground_map.h"
#include "render/geometry/moving_pieces.h"
#include "render/geometry/scene_rays.h"
#include "render/lighting/bake.h"
#include "render/lighting/live_light.h"
#include "render/media/medium.h"
#include "render/colour/frame_light.h"
#include "render/scene/scene.h"
#include "render/transport/lamp_bounce.h"
#include "render/view/render_options.h"

namespace rubble {

struct LitScene {
  // progress: called with the done fraction, 0 to 1. The device must outlive the scene.
  LitScene(Device& device, const Scene& scene, const RenderOptions& options,
           const std::function<void(double)>& progress);
  LitScene(const LitScene&) = delete;  // its parts refer to each other
  LitScene& operator=(const LitScene&) = delete;

  Device& device;                         // must be current in every call
  RenderOptions options;                  // as given
  ThreadPool pool;                        // for all work on it: several pools would wait for each other's processors
  PreparedScene scene;                    // as it stands at the moment of the last move_to()
  SceneRays rays;                         // of that scene
  GroundMap ground_map;                   // of debris on the ground
  std::vector<PatternImage> patterns;     // of the looks
  MovingPieces moving;                    // what move_to() moves
  LightSet light;                         // of the place, carried lights as at the moment of the last move_to()
  LightSet resting_light;                 // without carried ones
  Medium medium;                          // fog, smoke and dust
  std::int64_t start_ns;                  // the stamp at which the time of the medium is zero
  std::uint64_t seed;                     // as Scene::seed
  std::unique_ptr<DeviceScene> on_device;  // never null
  std::unique_ptr<LiveLight> live_light;  // where something moves
  FrameLight frame_light;                 // without what depends on the view

  // Colours are path traced: nothing of the light is baked or lit live.
  bool is_traced() const { return options.colour.quality == RenderQuality::reference; }
  // Puts what moves where it is at that stamp, and lights it there.
  void move_to(std::int64_t stamp_ns);
  // Baked light in the air.
  const AirLight& air_light() { return bake_ ? bake_->air() : open_sky_.air; }
  // Finds the light of those placed meshes, of which some pixel is seen, and brings it to the device. pieces: in any
  // order, some perhaps more than once; nothing: all.
  void light_pieces(const std::optional<std::vector<std::uint32_t>>& pieces);
  bool knows_all_light() const { return !bake_ || bake_->knows_all(); }
  // Brings the light of the place to the air of that stamp, and to the device, if it is not there yet.
  void light_air(std::int64_t stamp_ns);
  // How fog changes it; null: the air is clear, or nothing is baked.
  FogLight* fog_light() { return medium.clear() ? nullptr : fog_light_.get(); }
  // Finds what the lamp lights. bearer: of it, in the world. False: none of its light goes by way of surfaces.
  bool aim_lamp(const Pose& bearer, std::int64_t stamp_ns);
  // Since aim_lamp(): whether an image at that exposure may show that light, and whether it is worth asking.
  bool bounce_shows(float exposure) const;
  bool lamp_is_in_the_open() const;
  // Adds that light to the baked one, on the triangles that show, and to the fog. shown: asked where the processor adds it.
  void add_bounce(const std::function<std::vector<LampBounce::Shown>()>& shown);
  // The device finds the lamp's light in the air itself.
  bool lamp_fog_on_device() const { return device_lamp_ && lamp_fog_; }
  void leave_bounce_out();
  // The medium at that stamp.
  Air air_at(std::int64_t stamp_ns) const;
  void change(const LampSpec& lamp, const AirSpec& air);

 private:
  // What of the scene rests; where nothing moves, the scene itself.
  struct RestingPart {
    RestingPart(const PreparedScene& whole, SceneRays& whole_rays, bool moves);
    RestingPart(const RestingPart&) = delete;
    RestingPart& operator=(const RestingPart&) = delete;

    PreparedScene own;  // empty: it is the whole
    SceneRays own_rays;
    const PreparedScene& scene;
    SceneRays& rays;
    // Placed meshes of the scene in the whole, and the other way round; the latter kNone: it moves.
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> in_whole, in_part;
  };

  void place_carried_lights();
  void bake(double wetness, const std::function<void(double)>& progress);
  std::vector<std::uint32_t> lit_pieces() const;
  void aim_at(const PlacedLamp& lamp, float extinction);
  const LightTable& resting_nodes() const { return bake_ ? bake_->nodes() : open_sky_.nodes; }
  const LightTable& clear_nodes() const { return live_light ? live_light->light() : resting_nodes(); }
  const LightTable& nodes() { return fog_light() ? weakened_nodes_ : clear_nodes(); }

  // The light of an image: handed to the device. changed: where it differs from what was
  // shown before; null: anywhere.
  void show_light(const LightTable& light, const std::vector<LightRange>* changed = nullptr);

  std::vector<CarriedLight> carried_lights_;
  std::unique_ptr<RestingPart> resting_;     // what is baked
  std::unique_ptr<LightBake> bake_;          // of that; null: the sky is open
  OpenSkyLight open_sky_;                    // instead
  LightTable weakened_nodes_;   // by the fog
  std::unique_ptr<FogLight> fog_light_;      // made when there is first fog
  bool air_changed_ = false, surfaces_changed_ = false;  // since light_air()
  // Made when a lamp is first lit; one of the latter two is null.
  std::unique_ptr<LampReach> lamp_reach_;
  std::unique_ptr<LampBounce> lamp_bounce_;
  DeviceLamp* device_lamp_ = nullptr;
  std::uint64_t light_version_ = 1;          // of nodes()
  bool lit_by_lamp_ = false;                 // the light on the device is the lamp's too
  FogLight* lamp_fog_ = nullptr;             // the fog that shows the lamp's light; null: none does
};

}  // namespace rubble
