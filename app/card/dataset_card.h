// What a person who downloads a dataset reads first, from its manifest alone.
#pragma once

#include <map>
#include <string>

#include "app/card/splits.h"
#include "app/mission/finished_run.h"

namespace rubble {

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
