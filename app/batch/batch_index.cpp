// index.csv: the figures of every seed.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "app/batch/batch.h"
#include "app/batch/batch_folder.h"
#include "app/mission/finished_run.h"
#include "app/provenance/manifest.h"
#include "io/base/escaped_text.h"
#include "kernel/base/number_text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

struct Row {
  std::uint64_t seed = 0;
  std::size_t variant = 0;
  std::string name;  // of its folder
  RunState state = RunState::missing;
  std::string state_hash;
  std::uint64_t bytes = 0;  // of the files that the manifest names
  std::map<std::string, double> metrics;
  std::vector<std::pair<std::string, std::string>> drawn;  // by rubble.random
  std::string altered;  // why its figures cannot be trusted; empty: they can
};

const char* name_of(const Row& row) {
  if (row.state == RunState::failed) return "failed";
  if (row.state != RunState::done) return "missing";
  if (!row.altered.empty()) return "altered";
  const auto settled = row.metrics.find("settled");
  return settled != row.metrics.end() && settled->second == 0 ? "did_not_settle" : "done";
}

// Throws InputError when it cannot be read, is altered, or is not of what lies beside it.
Manifest read_trusted_manifest(const std::string& folder, std::uint64_t seed,
                               const std::vector<std::string>& varied) {
  const FinishedRun saved = open_finished_run(folder);
  const std::string path = folder + "/manifest.json";
  if (saved.manifest.seed != seed)
    throw InputError({path, 0, "seed", "belongs to another seed", std::to_string(seed),
                      std::to_string(saved.manifest.seed), ""});
  const std::vector<std::string>& set = saved.manifest.provenance.overrides;
  for (const std::string& text : varied)
    if (std::find(set.begin(), set.end(), text) == set.end())
      throw InputError({path, 0, "request", "belongs to another value", text, "", ""});
  load_pile_of(saved);
  return saved.manifest;
}

// The script runs again for them: the manifest has its text and its seed.
std::vector<std::pair<std::string, std::string>> read_drawn(const Manifest& manifest) {
  try {
    return load_mission(manifest.provenance).drawn;
  } catch (const InputError&) {
    return {};  // a script that this program does not take any more
  }
}

Row make_row(const BatchFolder& folder, const Sweep& sweep, std::size_t variant,
             std::uint64_t seed) {
  Row row;
  row.seed = seed;
  row.variant = variant;
  row.name = sweep.run_name(variant, std::to_string(seed));
  row.state = folder.state_of(row.name);
  if (row.state != RunState::done) return row;
  try {
    const Manifest manifest = read_trusted_manifest(folder.of(row.name), seed, sweep.overrides(variant));
    row.state_hash = manifest.pile.state_hash;
    row.metrics = manifest.metrics;
    row.drawn = read_drawn(manifest);
    std::error_code failed;
    for (const auto& item : manifest.outputs) {
      const auto size = std::filesystem::file_size(folder.of(row.name) + "/" + item.first, failed);
      if (!failed) row.bytes += size;
    }
  } catch (const InputError& error) {
    row.altered = error.what();
  }
  return row;
}

// What is drawn by name comes in the order in which a script draws it.
using DrawnNames = std::vector<std::string>;
void add_names(const Row& row, DrawnNames& names) {
  for (const auto& [name, value] : row.drawn)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string format_row(const Row& row, const Sweep& sweep, const DrawnNames& drawn,
                       const std::set<std::string>& columns) {
  std::string line = std::to_string(row.seed) + "," + name_of(row) + "," + row.state_hash + ",";
  if (row.state == RunState::done && row.altered.empty()) line += std::to_string(row.bytes);
  if (sweep.varies()) line += "," + std::to_string(row.variant + 1);
  for (const std::string& value : sweep.variants[row.variant]) line += "," + csv_text(value);
  for (const std::string& name : drawn) {
    line += ",";
    for (const auto& [of, value] : row.drawn)
      if (of == name) line += csv_text(value);
  }
  for (const std::string& column : columns) {
    const auto found = row.metrics.find(column);
    line += "," + (found == row.metrics.end() ? "" : exact_text(found->second));
  }
  return line + "\n";
}

}  // namespace

BatchIndex make_batch_index(const std::string& path, const Sweep& sweep,
                            const std::vector<std::uint64_t>& seeds) {
  const BatchFolder folder(path);
  std::vector<Row> rows;
  std::set<std::string> columns;
  DrawnNames drawn;
  for (std::size_t variant = 0; variant < sweep.variants.size(); ++variant)
    for (const std::uint64_t seed : seeds) {
      rows.push_back(make_row(folder, sweep, variant, seed));
      for (const auto& metric : rows.back().metrics) columns.insert(metric.first);
      add_names(rows.back(), drawn);
    }
  BatchIndex index;
  std::string& text = index.text;
  text = "seed,status,state_hash,bytes";
  if (sweep.varies()) text += ",variant";
  for (const std::string& key : sweep.keys) text += "," + csv_text(key);
  for (const std::string& name : drawn) text += "," + csv_text("random." + name);
  for (const std::string& column : columns) text += "," + column;
  text += "\n";
  for (const Row& row : rows) {
    text += format_row(row, sweep, drawn, columns);
    if (!row.altered.empty())
      index.altered.push_back((sweep.varies() ? row.name : "seed " + std::to_string(row.seed)) +
                              ": " + row.altered);
  }
  return index;
}

}  // namespace rubble
