// Planned ways, kept between runs under the hash of all they follow from: the waypoints that were asked for and the
// geometry of the pile. Rendering a flight again with other cameras, light or air then searches nothing.
#pragma once

#include <optional>
#include <string>

#include "app/planning/pile_survey.h"
#include "kernel/base/system/disk_cache.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// What planning makes of a trajectory, before it is smoothed.
struct PlannedWay {
  TrajectorySpec trajectory;  // every place a number, every leg free
  std::string report;         // its part of flight.json, as JSON
  std::string summary;        // a few words for the person who waits
};

class FlightCache {
 public:
  // asked: before planning. Its frame rate, limits and smoothing have no influence.
  FlightCache(const DiskCache& cache, const TrajectorySpec& asked, const PileSurvey& survey);

  std::optional<PlannedWay> find() const;
  void store(const PlannedWay& way) const;

 private:
  const DiskCache& cache_;
  const TrajectorySpec& asked_;
  std::string key_;  // empty: no cache
};

}  // namespace rubble
