// The baselines, and what they share. Internal to app/search.
#pragma once

#include <memory>
#include <vector>

#include "app/search/search_agent.h"

namespace rubble {

// Warm places that were seen, gathered to one spot for each body.
class HeatReports {
 public:
  explicit HeatReports(const SearchBriefing& briefing);

  // Takes in what is seen; gives the spots that have been seen from near enough, each once.
  std::vector<Vec3> update(const SearchObservation& seen);

 private:
  struct Spot {
    std::vector<Vec3> points;  // of its surface, a few centimetres apart
    double nearest = 1e9;      // from which it was seen; unit: m
    bool reported = false;
    Vec3 middle() const;
  };
  void add(const Vec3& point, double range);

  SearchRules rules_;
  DepthRays rays_;
  std::vector<Spot> spots_;
};

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
