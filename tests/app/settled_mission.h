// A mission's pile, settled in memory, with what tests ask of it.
#pragma once

#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/scene/build_scene.h"
#include "kernel/queries/queries.h"
#include "kernel/settling/settle.h"
#include "scripting/mission.h"

namespace rubble::testing {

struct SettledMission {
  Mission mission;
  AssetLibrary assets;
  Pile pile;
  PileState state;

  // As the physics sees it: boxes are exact.
  PileQueries queries() const;
  // The largest distance that a placed piece moved from where it was put; unit: m
  double largest_move() const;
};

SettledMission settle(const Mission& mission);
SettledMission settle_text(const std::string& script);

// The area of what is free in the plane y = `y`, for x0 < x < x1, between the ground and the first
// thing above it; unit: m2
double calc_free_section(const PileQueries& queries, double x0, double x1, double y,
                         double from_z = 0.001);

}  // namespace rubble::testing
