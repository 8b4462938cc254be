// Agents over the piles of many seeds, and the table of what they found.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/eval/scores/score_table.h"
#include "app/search/search_agent.h"
#include "app/support/run_request.h"

namespace rubble {

struct SearchBenchRequest {
  RunRequest of;                       // the mission; `seed` is not looked at; out: the folder
  std::string seeds = "1..10";         // --seeds
  std::string agent;                   // --agent: a command; empty: none
  std::vector<std::string> baselines;  // --baseline: of baseline_names()
  double deadline = 10;                // --deadline, for an answer of the agent; unit: s
};

struct SearchResult {
  std::uint64_t seed = 0;
  std::string agent;  // "agent", or the baseline's name
  SearchScore score;
};

// Settles the pile of each seed and lets every agent search it. Seeds whose voids have no room for the victims are
// left out, the same for all agents; `note` is told of them and of each search. Throws InputError and RunError.
std::vector<SearchResult> run_search_bench(const SearchBenchRequest& request,
                                           const std::function<void(const std::string&)>& note);

// One row for each agent: means over seeds, some with their confidence intervals.
std::vector<ScoreRow> make_search_table(const std::vector<SearchResult>& results);
// One row for each search.
std::vector<ScoreRow> list_searches(const std::vector<SearchResult>& results);

}  // namespace rubble
