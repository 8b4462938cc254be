// The baselines, one source each. Internal to app/search.
#pragma once

#include <memory>

#include "app/search/search_agent.h"

namespace rubble {

std::unique_ptr<SearchAgent> make_random_walk(const SearchBriefing& briefing);
std::unique_ptr<SearchAgent> make_wall_follower(const SearchBriefing& briefing);
std::unique_ptr<SearchAgent> make_frontier_explorer(const SearchBriefing& briefing);
std::unique_ptr<SearchAgent> make_octomap_explorer(const SearchBriefing& briefing);
std::unique_ptr<SearchAgent> make_oracle(const SearchBriefing& briefing, const SearchWorld& world);

// Flies towards a place, the camera ahead: turns on the spot while it looks elsewhere.
SearchCommand fly_towards(const SearchPose& pose, const Vec3& place, const SearchRules& rules);
// From -pi to pi; unit: rad.
double wrapped(double angle);

}  // namespace rubble
