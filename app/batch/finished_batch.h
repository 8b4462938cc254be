// A batch, read back from its folder: what was run, and the table of its runs.
#pragma once

#include <string>
#include <vector>

#include "app/batch/csv_table.h"

namespace rubble {

struct FinishedBatch {
  using Row = std::vector<std::string>;

  std::string folder;              // as it was given
  CsvTable table;                  // index.csv; it has the columns `seed` and `status`
  std::string mission;             // name of the script
  std::string seeds;               // as they were asked for: "1..20"
  std::string program;             // version and commit of the program that ran it
  std::vector<std::string> swept;  // keys that were varied: columns of the table, too

  // The name of its folder.
  std::string run_of(const Row& row) const;
  const std::string& seed_of(const Row& row) const;
  const std::string& status_of(const Row& row) const;
};

// Whether a batch was begun there.
bool is_batch_folder(const std::string& folder);

// Throws InputError when there is no batch that came to its end, or its files cannot be read.
FinishedBatch open_finished_batch(const std::string& folder);

}  // namespace rubble
