// Writers of scenes, one folder each: io/scenes/sim_scene.h in the words of one family of simulators. Each throws RunError
// when a file cannot be written.
#pragma once

#include <string>
#include <vector>

#include "io/scenes/sim_scene.h"

namespace rubble {

void write_mjcf(const std::string& folder, const ExportModel& model);  // pile.xml
void write_sdf(const std::string& folder, const ExportModel& model);   // pile.sdf
void write_urdf(const std::string& folder, const ExportModel& model);  // fixed.urdf, models/, robots/
void write_usd(const std::string& folder, const ExportModel& model);   // pile.usda

// What of a scene each format cannot say, a sentence each.
std::vector<std::string> mjcf_limits(const SimScene& scene);
std::vector<std::string> sdf_limits(const SimScene& scene);
std::vector<std::string> urdf_limits(const SimScene& scene);
std::vector<std::string> usd_limits(const SimScene& scene);

}  // namespace rubble
