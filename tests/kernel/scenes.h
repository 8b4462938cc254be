// Scenes and piece types shared by the kernel's tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/world/world.h"

namespace rubble::testing {

ConvexPart box_part(double x, double y, double z, const Vec3& centre = {});
PieceType box_type(const std::string& name, double x, double y, double z);
PieceType bar_type(double length, double radius);  // hexagonal, along X
PieceType chunk_type(const std::string& name, std::uint64_t seed, int points = 20);
PieceType pipe_type(double length, double inner, double outer, int segments = 12);  // along X
PieceType culvert_type();      // a box with an opening along X: four plates
PieceType cinder_block_type(); // 0.39 x 0.19 x 0.19 m with two vertical holes

// A square height field about the origin, of edge length `size`.
PieceType terrain_type(double size, double spacing,
                       const std::function<double(double x, double y)>& height);

// Chunks, slabs, blocks, bricks, bars, pipes and cinder blocks.
std::vector<PieceType> rubble_types();
PileSpec small_pile(std::uint64_t seed, int layers = 2, int pieces = 60);

// rubble_types(), then a terrain: a saddle with steps, so that it has ridges, hollows and level places.
std::vector<PieceType> hilly_types();
std::vector<NewPiece> pieces_on_hills();  // the terrain, fixed, and 40 pieces above it

// Of rubble_types(): slabs on bars that yield (ball joints), a frame with a leaf on a hinge and a
// drawer on a slider, a welded bundle; joints that break at loads which a pile reaches.
std::vector<AssemblyType> assemblies();

NewPiece at(PieceKind kind, const Vec3& position, const Quat& rotation = {}, bool fixed = false);
Quat turned(const Vec3& axis, double angle);

// Steps until rest (0.05 m/s, 0.2 rad/s) or until `seconds` are over; true at rest.
bool run_to_rest(World& world, double seconds);
void run(World& world, double seconds);

// Bit patterns of all poses and speeds.
std::uint64_t hash_of(const World& world);

}  // namespace rubble::testing
