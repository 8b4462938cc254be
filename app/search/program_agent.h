// An agent of the user's: a program that gets observations as lines of JSON and answers each with one.
// docs/explanation/search.md describes the lines.
#pragma once

#include <memory>
#include <string>

#include "app/search/search_agent.h"

namespace rubble {

struct ProgramAgentOptions {
  std::string command;    // for /bin/sh
  std::string log;        // file for its standard error
  double deadline = 10;   // for an answer, on the wall's clock; of the first one: three times that; unit: s
};

std::unique_ptr<SearchAgent> start_program_agent(const ProgramAgentOptions& options, const SearchBriefing& briefing);

}  // namespace rubble
