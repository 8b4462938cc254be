// What draws: the processor, with the same bits on every machine, or a graphics card. Renderers, sensors and programs know
// this interface alone; render/devices has its implementations.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/colour/colour_pass.h"
#include "render/device/device_lamp.h"
#include "render/geometry/ground_map.h"
#include "render/geometry/scene_tables.h"
#include "render/materials/textures.h"
#include "render/passes/triangle_raster.h"

namespace rubble {

// For `rubble info` and the manifest.
struct DeviceInfo {
  std::string name;                                          // "software" or "gl"
  std::string about;                                         // what it runs on, such as "AVX2"
  std::vector<std::pair<std::string, std::string>> details;  // names and values, such as the driver's version
  std::vector<std::pair<std::string, int>> limits;           // names and values of those that matter here
};

// Since the device was opened; a device that is the processor has none.
struct DeviceTraffic {
  std::uint64_t given = 0, taken = 0;  // to the device and back; unit: byte
  std::uint64_t waits = 0;             // of the processor for the device
};

struct DeviceSceneOptions {
  int shadow_side = 4096;       // of a shadow map at most; unit: texel
  bool shades = true;           // false: colours are not asked for
  std::string instruction_set;  // as RenderOptions
};

// A scene on a device, as it stands at the moment of the last move().
class DeviceScene {
 public:
  virtual ~DeviceScene() = default;

  virtual const TriangleNames& names() const = 0;
  virtual TriangleRaster& raster() = 0;
  // Of the lights. Valid until the next move(); not to be asked of a device that does not shade.
  virtual const ShadowViews& shadows() const = 0;
  // Pieces and carried lights have moved in the scene and the lights that it was made of.
  virtual void move() = 0;
  // The light of an image, which stays where it is. changed: where it differs from what was given before; null: anywhere.
  virtual void set_light(const LightTable& light, const std::vector<LightRange>* changed) = 0;
  // Null: this device does not find the lamp's light; the processor adds it to what set_light() gets. Else the same for all
  // calls, and it may be asked for before the first picture alone. links: must outlive it; first_point: as LampBounce.
  virtual DeviceLamp* lamp(const BakeLinks& links, const std::vector<std::uint32_t>& first_point) {
    return (void)links, (void)first_point, nullptr;
  }
  // What it refers to must outlive it, and this must. light: without what depends on the view.
  virtual std::unique_ptr<ColourPass> make_colour_pass(const FrameLight& light, const GroundMap& ground,
                                                       const std::vector<PatternImage>& patterns) = 0;
};

class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const = 0;
  virtual DeviceTraffic traffic() const { return {}; }
  // It draws while the processor goes on: see RenderedView::begin().
  virtual bool runs_ahead() const { return false; }
  // One thread at a time may use a device and what it made; this moves it to the calling one.
  virtual void make_current() {}

  // The scene, the lights and the pool must outlive it. light: at all nodes, at first. pool: the one for all work on the
  // scene, whose threads would else wait for each other's processors.
  virtual std::unique_ptr<DeviceScene> load(const PreparedScene& scene, const LightSet& lights,
                                            const LightTable& light, const DeviceSceneOptions& options,
                                            ThreadPool& pool) = 0;
};

}  // namespace rubble
