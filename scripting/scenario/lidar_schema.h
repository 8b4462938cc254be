// The keys of `lidars`, and what is wrong with them that no single key shows.
#pragma once

#include <string>
#include <vector>

#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"

namespace rubble {

void add_lidar_keys(Schema& keys, Scenario& scenario);
void check_lidars(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

// The topic of that LiDAR: its own key, or `/points` (`/scan` of a 2-D scanner) where it is the only one
// of its kind, else `/NAME/points` and `/NAME/scan`.
std::string lidar_topic(const Scenario& scenario, std::size_t lidar);

}  // namespace rubble
