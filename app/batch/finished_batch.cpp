#include "app/batch/finished_batch.h"

#include <filesystem>

#include "app/support/json_members.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {

std::string FinishedBatch::run_of(const Row& row) const {
  const int variant = table.find("variant");
  return (variant < 0 ? "" : "v" + row[std::size_t(variant)] + "_") + "seed_" + seed_of(row);
}

const std::string& FinishedBatch::seed_of(const Row& row) const {
  return row[std::size_t(table.find("seed"))];
}

const std::string& FinishedBatch::status_of(const Row& row) const {
  return row[std::size_t(table.find("status"))];
}

bool is_batch_folder(const std::string& folder) {
  std::error_code failed;
  return std::filesystem::exists(folder + "/batch.json", failed);
}

FinishedBatch open_finished_batch(const std::string& folder) {
  allow_results(folder);
  const std::string file = folder + "/batch.json", index = folder + "/index.csv";
  std::error_code failed;
  if (!is_batch_folder(folder) || !std::filesystem::exists(index, failed))
    throw InputError({folder, 0, "", "there is no finished batch",
                      "batch.json and index.csv, as `rubble batch` leaves them", "", ""});
  const auto json = parse_json_text(read_whole_file(file), file);
  const JsonMembers members(json, file);
  FinishedBatch batch{folder, parse_csv(read_whole_file(index), index), "", "", "", {}};
  for (const char* column : {"seed", "status"})
    if (batch.table.find(column) < 0)
      throw InputError({index, 1, column, "the table has no such column", "", "", ""});
  batch.mission = members.object("script").text("name");
  batch.seeds = members.text("seeds");
  batch.program = members.text("program");
  if (members.has("vary"))
    for (const JsonMembers& text : members.list("vary"))
      batch.swept.push_back(text.as_text().substr(0, text.as_text().find('=')));
  return batch;
}

}  // namespace rubble
