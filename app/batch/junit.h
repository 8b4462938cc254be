// Results of a suite as JUnit XML, which GitHub, GitLab and Jenkins read.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct CaseResult {
  std::string name;                   // "heap/seed_3"
  double seconds = 0;                 // wall-clock time; unit: s
  std::vector<std::string> failures;  // expectations that are not met, a sentence each
  std::string error;                  // why there is nothing to look at; empty: there is
  std::string log;                    // the end of what the run printed
  bool passed() const { return failures.empty() && error.empty(); }
};

// A well-formed XML 1.0 document, whatever the texts hold.
std::string make_junit(const std::string& suite, const std::vector<CaseResult>& cases);

}  // namespace rubble
