// What the paint of a triangle is at one point of it, by the formulas of shaders/surface_model.glsl.
#pragma once

#include <array>

#include "render/geometry/prepared_mesh.h"
#include "render/materials/paint_layers.h"

namespace rubble {

struct PaintQuery {
  std::array<Vec3f, 3> corners;  // of the triangle; unit: m
  std::array<float, 3> weights;  // of its corners
  Vec3f normal;                  // with rounding, unit, in the frame of the corners
  float footprint = 0;           // width of what is seen, measured across the surface, in the unit of the corners
};

struct PaintPoint {
  Vec3f albedo;  // linear light, of metal and matt base alike
  Vec3f normal;  // with relief, unit
  float roughness = 1, metalness = 0, reflectance = 0;  // as paint_over() wants them
};

PaintPoint find_paint(const PaintLayers& layers, const TrianglePaint& paint, const PaintQuery& query);

}  // namespace rubble
