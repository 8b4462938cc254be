// What a person who downloads a dataset reads first, from its manifest alone; and the parts that cards of batches share.
// All texts are Markdown.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "app/mission/finished_run.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

inline constexpr std::array<const char*, 3> kSplits{"train", "val", "test"};

// In percent, on average over many seeds; range of each: 0 to 100, sum 100.
struct SplitShares {
  int train = 80, val = 10, test = 10;

  std::array<int, 3> as_list() const { return {train, val, test}; }  // in the order of kSplits
};

// "80,10,10". Throws InputError naming --splits.
SplitShares parse_shares(const std::string& text);

// An index into kSplits.
int split_of(std::uint64_t seed, const SplitShares& shares);

// The rule in words, for a card; Markdown.
std::string describe_rule(const SplitShares& shares);

// The section of a card about a single run.
std::string describe_split(std::uint64_t seed, const SplitShares& shares);

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

struct CardText {
  std::string title;    // empty: the name of the script and the seed
  std::string licence;  // empty: the card says that none is stated
  SplitShares shares;   // of training, validation and testing
};

// Markdown with a YAML head: sensors, rates, frames, truth, licence, sizes, seed, how to remake.
std::string make_dataset_card(const FinishedRun& saved, const CardText& text);

// Lines as `sha256sum -c` reads them: of the manifest, of every file that it names, and of further ones
// (names relative to the folder). before: written before every name. Throws RunError for a file that
// cannot be read.
std::string make_checksums(const FinishedRun& saved, const std::map<std::string, std::string>& further,
                           const std::string& before = "");

}  // namespace rubble
