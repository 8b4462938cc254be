// A small mission's run, and what of its manifest must come out again: for the tests of verify, remake,
// render and resume.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program.h"

namespace rubble::testing {

nlohmann::ordered_json read_manifest(const std::string& folder);
// All of a manifest that must be the same for the same run.
nlohmann::ordered_json reproducible(const std::string& folder);
// Runs kTinyMission into the folder `name`; more: arguments.
void run_tiny(const ScratchFolder& scratch, const std::string& name, const std::string& more = "");
// Replaces the first `from` in a file; a failure where there is none.
void alter(const std::string& file, const std::string& from, const std::string& to);

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace rubble::testing
