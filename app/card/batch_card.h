// What is handed on with a batch: a card, the splits of its runs, checksums.
#pragma once

#include <map>
#include <string>

#include "app/batch/finished_batch.h"
#include "app/card/dataset_card.h"

namespace rubble {

// Name in the folder -> text: splits/train.txt, splits/val.txt, splits/test.txt, with the folder of a run in
// each line. Runs that failed or did not come to rest are in none.
std::map<std::string, std::string> make_splits(const FinishedBatch& batch, const SplitShares& shares);

// "splits/train.txt"; index: into kSplits
std::string split_file(std::size_t index);

// Markdown with a YAML head, about the runs together; sensors are those of the first run that is done.
// Throws InputError when none is.
std::string make_batch_card(const FinishedBatch& batch, const CardText& text);

// As make_checksums, for the files of every run that is done or did not settle, and of the batch.
std::string make_batch_checksums(const FinishedBatch& batch, const std::map<std::string, std::string>& further);

}  // namespace rubble
