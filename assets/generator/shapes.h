// Building blocks that several families of pieces share.
#pragma once

#include <string>

#include "assets/generator/asset.h"
#include "kernel/base/random.h"

namespace rubble::generator {

// Every piece draws from a stream of its own, so that adding one changes no other.
RandomStream piece_stream(const std::string& name);

std::vector<Vec3> box_corners(const Vec3& min, const Vec3& max);

// A recipe of the pack's reinforced concrete with its own noise.
Recipe concrete_recipe(const std::string& name, RandomStream& random);

// How far a ray from inside a cell runs until it leaves it. direction: unit length; unit: m
double exit_distance(const Cell& cell, const Vec3& from, const Vec3& direction);

// A bar that comes out of the cell along `direction` through a point inside, broken off short or
// left long and bent, as the stream draws. Bars shorter than 5 cm outside are drawn only.
Bar protruding_bar(const Cell& cell, const Vec3& through, const Vec3& direction, double radius,
                   RandomStream& random);

}  // namespace rubble::generator
