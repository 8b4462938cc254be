// One search: the robot in its world, step by step, and what it earned.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/search/search_world.h"
#include "kernel/base/random.h"
#include "kernel/voids/seen_cells.h"

namespace rubble {

// What the robot senses. Pictures row by row from the top; see SearchRules.
struct SearchObservation {
  double time = 0;               // since the start; unit: s
  SearchPose pose;               // in the world, exact
  bool stopped = false;          // something was in the way in the last step
  std::vector<float> depth;      // along the optical axis; infinite: nothing within max_range; unit: m
  std::vector<float> thermal;    // unit: K
  int found = 0;                 // victims
  int reports_left = 0;
};

struct SearchAction {
  SearchCommand command;
  std::vector<Vec3> reports;  // where a victim is; unit: m
  bool done = false;          // the search ends here
};

struct SearchScore {
  int victims = 0, found = 0;
  int false_reports = 0;  // that were near nobody
  double coverage = 0;    // share of the void volume that the robot can reach, which its camera saw
  double spl = 0;         // mean over victims: shortest way over way flown when reported; 0 of those not found
  int collisions = 0;     // steps in which something was in the way
  double path = 0;        // flown; unit: m
  double time = 0;        // simulated, when it ended; unit: s
  std::string failure;    // of the agent, for a person; empty: none
};

class SearchEpisode {
 public:
  // seed: of the noise of the thermal picture. The world must outlive it.
  SearchEpisode(const SearchWorld& world, std::uint64_t seed);

  const SearchObservation& observation() const { return seen_; }
  // Takes the reports, flies for a period, looks. Commands beyond the limits are cut to them. Throws InputError for
  // a number that is not finite.
  void step(const SearchAction& action);
  // The time is up, the agent said so, or everybody is found.
  bool over() const;
  SearchScore score() const;

 private:
  void take_report(const Vec3& place);
  bool fly(const SearchCommand& command);
  void look();
  void mark_seen(const Pose& world_from_camera);

  const SearchWorld& world_;
  RandomStream noise_;
  SearchObservation seen_;
  std::vector<std::int32_t> pieces_;        // that the pixels show
  SeenCells seen_cells_;                    // of those that the robot can reach
  std::vector<double> reported_;            // path flown when each target was reported; below 0: not yet
  SearchScore score_;
  int steps_ = 0;
  bool done_ = false;
};

}  // namespace rubble
