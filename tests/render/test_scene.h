// Scenes made by code, shared between tests and the picture driver: no physics, no files.
#pragma once

#include <cstdint>

#include "render/scene/frame.h"
#include "render/scene/scene.h"
#include "render/streams/image_streams.h"

namespace rubble::testing {

// A closed box around the origin, flat-shaded, all of one surface.
TriangleMesh make_box(const Vec3& size, const char* surface = "concrete_cast");
// A closed sphere of radius 1: `rings` bands of `2 * rings` quads.
TriangleMesh make_sphere(int rings, const char* surface = "concrete_cast");
// A convex lump with broken faces, about 1 m across.
TriangleMesh make_chunk(std::uint64_t seed, const char* cast, const char* broken);

std::shared_ptr<const SceneMesh> share(TriangleMesh mesh);

// A heap of `pieces` slabs, chunks, bricks and bars on the ground with a void under a large slab
// on two walls: x from -1.5 to 1.5, y from -1.2 to 1.2, open at +x. Deterministic.
Scene make_heap(int pieces, std::uint64_t seed);

// A closed room of six slabs of one look about the origin, dark but for the lamp on the camera. inside: its size; unit: m
Scene slab_room(const Vec3& inside);

// Streams of a frame.
inline const auto& normals_of(const Frame& frame) { return frame.get<float>("normals"); }
inline const auto& instances_of(const Frame& frame) { return frame.get<std::uint32_t>("instance"); }
inline const auto& labels_of(const Frame& frame) { return frame.get<std::uint16_t>("label"); }
inline const auto& flow_of(const Frame& frame) { return frame.get<float>("flow"); }
inline const auto& sky_of(const Frame& frame) { return frame.get<float>("sky_visibility"); }

// A camera at `eye` that looks at `target`, upright.
Pose look_at(const Vec3& eye, const Vec3& target);
Intrinsics pinhole(int width, int height, double focal);

}  // namespace rubble::testing
