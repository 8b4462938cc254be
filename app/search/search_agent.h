// Who searches: a baseline of ours, or a program at the other end of a pipe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/search/search_episode.h"
#include "kernel/base/error.h"

namespace rubble {

// What an agent is told before the first observation.
struct SearchBriefing {
  std::uint64_t seed = 0;  // for the agent's own chance
  SearchRules rules;
  int victims = 0, reports = 0;
  Aabb bounds;  // of the pile, in the world; unit: m
};

class SearchAgent {
 public:
  virtual ~SearchAgent() = default;
  // Throws AgentFailure.
  virtual SearchAction act(const SearchObservation& seen) = 0;
  // The search is over.
  virtual void end(const SearchScore& score) { (void)score; }
};

// The agent hangs, died, or says what nobody understands: its search ends here, with a sentence for a person.
struct AgentFailure {
  std::string what;
};

// random: ahead until something is in the way, then any other direction; wall: along the wall at its right hand;
// frontier: to the nearest place at the edge of what it knows; octomap: the same on OctoMap's map; oracle: straight to every victim, by the map of the
// voids, as an upper bound. All but the oracle know only what they are shown.
std::vector<std::string> baseline_names();
InputError unknown_baseline(const std::string& name);
// The world must outlive the agent; only the oracle looks at it. name: of baseline_names().
std::unique_ptr<SearchAgent> make_baseline(const std::string& name, const SearchBriefing& briefing,
                                           const SearchWorld& world);

SearchBriefing make_briefing(const SearchWorld& world, std::uint64_t seed);

// Plays until it is over; score().failure says what the agent did wrong, if anything.
SearchScore play_search(const SearchWorld& world, std::uint64_t seed, SearchAgent& agent);

}  // namespace rubble
