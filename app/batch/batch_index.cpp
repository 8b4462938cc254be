// index.csv: the figures of every seed.
#include <filesystem>
#include <map>
#include <set>

#include "app/batch/batch.h"
#include "app/batch/batch_folder.h"
#include "app/pipeline/finished_run.h"
#include "app/provenance/manifest.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

struct Row {
  std::uint64_t seed = 0;
  SeedState state = SeedState::missing;
  std::string state_hash;
  std::uint64_t bytes = 0;  // of the files that the manifest names
  std::map<std::string, double> metrics;
  std::string altered;  // why its figures cannot be trusted; empty: they can
};

const char* name_of(const Row& row) {
  if (row.state == SeedState::failed) return "failed";
  if (row.state != SeedState::done) return "missing";
  if (!row.altered.empty()) return "altered";
  const auto settled = row.metrics.find("settled");
  return settled != row.metrics.end() && settled->second == 0 ? "did_not_settle" : "done";
}

// Throws InputError when it cannot be read, is altered, or is not of what lies beside it.
Manifest read_trusted_manifest(const std::string& folder, std::uint64_t seed) {
  const FinishedRun saved = open_finished_run(folder);
  const std::string path = folder + "/manifest.json";
  if (saved.manifest.seed != seed)
    throw InputError({path, 0, "seed", "is of another seed", std::to_string(seed),
                      std::to_string(saved.manifest.seed), ""});
  load_pile_of(saved);
  return saved.manifest;
}

Row make_row(const BatchFolder& folder, std::uint64_t seed) {
  Row row;
  row.seed = seed;
  row.state = folder.state_of(seed);
  if (row.state != SeedState::done) return row;
  try {
    const Manifest manifest = read_trusted_manifest(folder.of_seed(seed), seed);
    row.state_hash = manifest.pile.state_hash;
    row.metrics = manifest.metrics;
    std::error_code failed;
    for (const auto& item : manifest.outputs) {
      const auto size = std::filesystem::file_size(folder.of_seed(seed) + "/" + item.first, failed);
      if (!failed) row.bytes += size;
    }
  } catch (const InputError& error) {
    row.altered = error.what();
  }
  return row;
}

std::string format_row(const Row& row, const std::set<std::string>& columns) {
  std::string line = std::to_string(row.seed) + "," + name_of(row) + "," + row.state_hash + ",";
  if (row.state == SeedState::done && row.altered.empty()) line += std::to_string(row.bytes);
  for (const std::string& column : columns) {
    const auto found = row.metrics.find(column);
    line += "," + (found == row.metrics.end() ? "" : format_number(found->second));
  }
  return line + "\n";
}

}  // namespace

BatchIndex make_batch_index(const std::string& path, const std::vector<std::uint64_t>& seeds) {
  const BatchFolder folder(path);
  std::vector<Row> rows;
  std::set<std::string> columns;
  for (const std::uint64_t seed : seeds) {
    rows.push_back(make_row(folder, seed));
    for (const auto& metric : rows.back().metrics) columns.insert(metric.first);
  }
  BatchIndex index;
  std::string& text = index.text;
  text = "seed,status,state_hash,bytes";
  for (const std::string& column : columns) text += "," + column;
  text += "\n";
  for (const Row& row : rows) {
    text += format_row(row, columns);
    if (!row.altered.empty())
      index.altered.push_back("seed " + std::to_string(row.seed) + ": " + row.altered);
  }
  return index;
}

}  // namespace rubble
