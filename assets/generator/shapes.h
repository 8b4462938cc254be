// Building blocks that several families of pieces share.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "assets/generator/asset.h"
#include "kernel/base/random.h"

namespace rubble::generator {

// Every piece draws from a stream of its own, so that adding one changes no other.
RandomStream piece_stream(const std::string& name);

std::vector<Vec3> box_corners(const Vec3& min, const Vec3& max);

// A convex outline extruded along an axis (0: x, outline in y and z; 1: y, in x and z; 2: z, in x
// and y). The outline may run either way round.
using Outline = std::vector<std::array<double, 2>>;
Cell extruded_cell(int axis, const Outline& outline, double low, double high, Surface surface);

// The solid cylinder about an axis-parallel line through `centre`, between two planes across it.
Cell cylinder_cell(int axis, const Vec3& centre, double radius, double low, double high,
                   Surface surface);

// How materials wear; see Wear. The fibres of timber run along X.
Wear timber_wear();
Wear plywood_wear();
Wear drywall_wear();
Wear steel_wear();
Wear fabric_wear();

// A piece with noise of its own and of any material.
Recipe plain_recipe(const std::string& name, RandomStream& random, const std::string& material,
                    const Wear& wear, double cell);

// Breaks a cell across one end of an axis: the face at `end` (1: the high end, -1: the low one)
// leans by up to `lean` and a second break runs across a random edge.
void break_end(Cell& cell, int axis, int end, double lean, Surface surface, RandomStream& random);

// A recipe of the pack's reinforced concrete with its own noise.
Recipe concrete_recipe(const std::string& name, RandomStream& random);

// How far a ray from inside a cell runs until it leaves it. direction: unit length; unit: m
double exit_distance(const Cell& cell, const Vec3& from, const Vec3& direction);

// A bar that comes out of the cell along `direction` through a point inside, broken off short or
// left long and bent, as the stream draws. Bars shorter than 5 cm outside are drawn only.
Bar protruding_bar(const Cell& cell, const Vec3& through, const Vec3& direction, double radius,
                   RandomStream& random);

}  // namespace rubble::generator
