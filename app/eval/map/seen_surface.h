// The part of a pile's true surface that the frames of a run show, sampled evenly by area.
#pragma once

#include <vector>

#include "app/eval/map/recorded_views.h"
#include "kernel/base/mesh.h"
#include "kernel/base/parallel.h"
#include "kernel/model/pile_state.h"
#include "kernel/queries/queries.h"

namespace rubble {

struct SeenPoints {
  std::vector<Vec3> points;  // unit: m
  double spacing = 0.02;     // each stands for spacing^2 of surface; unit: m

  double area() const { return double(points.size()) * spacing * spacing; }  // unit: m2
};

// Points are drawn evenly over the triangles of all pieces and over the ground, the same ones each
// time. One counts as seen when a frame has it in its picture and range, and an exact ray from the
// camera meets nothing before it.
//
// So that not every point of a pile is tried against every frame, rays through a grid of 128 points
// a row first find where each frame sees anything at all: a point farther than 0.2 m from all that
// a frame's grid met is not tried with that frame. meshes: by type, as PileQueries takes them.
SeenPoints find_seen_surface(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                             const PileQueries& queries, const RecordedViews& views,
                             double spacing, ThreadPool& pool);

}  // namespace rubble
