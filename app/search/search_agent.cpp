#include "app/search/search_agent.h"

#include "app/support/stop.h"
#include "kernel/base/error.h"

namespace rubble {

SearchBriefing make_briefing(const SearchWorld& world, std::uint64_t seed) {
  SearchBriefing briefing;
  briefing.seed = seed;
  briefing.rules = world.rules();
  briefing.victims = int(world.targets().size());
  briefing.reports = briefing.rules.reports_each * briefing.victims;
  briefing.bounds = world.bounds();
  return briefing;
}

SearchScore play_search(const SearchWorld& world, std::uint64_t seed, SearchAgent& agent) {
  SearchEpisode episode(world, seed);
  std::string failure;
  try {
    while (!episode.over()) {
      throw_if_stopped("");
      episode.step(agent.act(episode.observation()));
    }
  } catch (const AgentFailure& failed) {
    failure = failed.what;
  } catch (const InputError& error) {
    failure = error.what();
  }
  SearchScore score = episode.score();
  score.failure = failure;
  if (failure.empty()) agent.end(score);
  return score;
}

}  // namespace rubble
