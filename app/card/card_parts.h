// What the cards of a run and of a batch have in common. All texts are Markdown.
#pragma once

#include <cstddef>
#include <string>

#include "scripting/scenario/scenario.h"

namespace rubble {

// In double quotes of YAML, without what steers a terminal.
std::string yaml_quoted(const std::string& text);

// A cell of a table, and a line of two cells.
std::string table_cell(const std::string& text);
std::string table_row(const std::string& a, const std::string& b);

// Sections, with their headings. frames: of all cameras
std::string describe_sensors(const Scenario& scenario, std::size_t frames);
// And the frames of reference. flown: there are frames.
std::string describe_truth(const Scenario& scenario, bool flown);

// The head, which dataset hubs read as YAML, and the title. licence: empty: none is stated
std::string make_card_head(const std::string& title, const std::string& licence);
std::string make_card_licence(const std::string& licence);

}  // namespace rubble
