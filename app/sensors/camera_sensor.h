// Cameras of a mission as sensors: pictures on a planned flight, or while a robot that carries them is driven; or exact depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "app/sensors/build_camera.h"
#include "app/sensors/sensor.h"
#include "render/renderer.h"

namespace rubble {

// number: in the scenario's list. first_frame: number of its first frame. The renderer must outlive the sensor.
// Every frame of its flight, with all of its channels.
std::unique_ptr<Sensor> make_flown_camera(const SensorParts& parts, std::size_t number, const RigFlight& flight, int first_frame,
                                          Renderer& renderer);
// While its carrier moves: colours alone, developed as those that are recorded, drawn when their exposure has ended.
// Throws InputError where nothing carries it.
std::unique_ptr<Sensor> make_riding_camera(const SensorParts& parts, std::size_t number, Renderer& renderer);
// Planar depth by exact rays, without noise and without what the air does to depth sensors: frames of depth alone.
// Throws InputError where nothing carries it, and for a lens that is no pinhole.
std::unique_ptr<Sensor> make_depth_sensor(const SensorParts& parts, std::size_t number);

}  // namespace rubble
