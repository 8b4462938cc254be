// From warm pixels to reports: what the baselines share.
#pragma once

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

}  // namespace rubble
