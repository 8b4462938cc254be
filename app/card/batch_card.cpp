#include "app/card/batch_card.h"

#include <algorithm>
#include <set>

#include "app/card/dataset_card.h"
#include "kernel/base/hash.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

std::uint64_t seed_number(const FinishedBatch& batch, const FinishedBatch::Row& row) {
  try {
    return std::stoull(batch.seed_of(row));
  } catch (const std::exception&) {
    throw InputError({batch.folder + "/index.csv", 0, "seed", "is no seed", "a whole number", batch.seed_of(row), ""});
  }
}

bool has_dataset(const FinishedBatch& batch, const FinishedBatch::Row& row) {
  return batch.status_of(row) == "done" || batch.status_of(row) == "did_not_settle";
}

std::string find_first(const FinishedBatch& batch) {
  for (const auto& row : batch.table.rows)
    if (batch.status_of(row) == "done") return batch.run_of(row);
  throw InputError({batch.folder, 0, "", "no run of the batch is done", "", "",
                    "failed/ says why; `rubble batch` with the same arguments tries again"});
}

std::string describe_runs(const FinishedBatch& batch) {
  std::map<std::string, int> counts;
  for (const auto& row : batch.table.rows) ++counts[batch.status_of(row)];
  std::string text = std::to_string(batch.table.rows.size()) + " runs of `" + table_cell(batch.mission) + "`, seeds " +
                     printable(batch.seeds);
  for (const auto& [status, count] : counts) text += ", " + std::to_string(count) + " `" + printable(status) + "`";
  return text + ", simulated by Rubble " + printable(batch.program) +
         ". Each is a dataset in a folder of its own, with a manifest; `index.csv` has a row for each, with its "
         "status, the hash of its pile and its figures.\n\n";
}

std::string describe_swept(const FinishedBatch& batch) {
  if (batch.swept.empty()) return "";
  std::string text = "## Keys that vary\n\n| key | values |\n| --- | --- |\n";
  for (const std::string& key : batch.swept) {
    const int column = batch.table.find(key);
    std::set<std::string> values;
    for (const auto& row : batch.table.rows)
      if (column >= 0) values.insert(row[std::size_t(column)]);
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + value;
    text += table_row("`" + table_cell(key) + "`",
                      values.size() > 12 ? std::to_string(values.size()) + " values, in `index.csv`" : table_cell(list));
  }
  return text + "\n";
}

std::string describe_splits(const FinishedBatch& batch, const SplitShares& shares) {
  std::array<std::set<std::uint64_t>, 3> seeds;
  std::array<int, 3> runs{};
  for (const auto& row : batch.table.rows) {
    if (batch.status_of(row) != "done") continue;
    const std::uint64_t seed = seed_number(batch, row);
    const auto split = std::size_t(split_of(seed, shares));
    seeds[split].insert(seed);
    ++runs[split];
  }
  std::string text = "## Splits\n\n| split | share | seeds | runs | list |\n| --- | --- | --- | --- | --- |\n";
  for (std::size_t i = 0; i < 3; ++i)
    text += "| `" + std::string(kSplits[i]) + "` | " + std::to_string(shares.as_list()[i]) + " % | " +
            std::to_string(seeds[i].size()) + " | " + std::to_string(runs[i]) + " | `" + split_file(i) + "` |\n";
  return text + "\n" + describe_rule(shares) + "\n";
}

}  // namespace

std::string split_file(std::size_t index) { return "splits/" + std::string(kSplits[index]) + ".txt"; }

std::map<std::string, std::string> make_splits(const FinishedBatch& batch, const SplitShares& shares) {
  std::map<std::string, std::string> files;
  for (std::size_t i = 0; i < kSplits.size(); ++i) files[split_file(i)] = "";
  for (const auto& row : batch.table.rows)
    if (batch.status_of(row) == "done")
      files[split_file(std::size_t(split_of(seed_number(batch, row), shares)))] += batch.run_of(row) + "\n";
  return files;
}

std::string make_batch_card(const FinishedBatch& batch, const CardText& given) {
  const std::string run = find_first(batch);
  const FinishedRun first = open_finished_run(batch.folder + "/" + run);
  const Scenario s = stated_scenario(first.manifest.provenance);
  const std::string title = printable(given.title.empty() ? batch.mission + ", seeds " + batch.seeds : given.title);
  std::string text = make_card_head(title, given.licence) + describe_runs(batch) + describe_swept(batch) +
                     describe_splits(batch, given.shares);
  const std::size_t frames = first.manifest.frames.frames.size();
  if (frames > 0) text += describe_sensors(s, frames);
  text += describe_truth(s, frames > 0);
  if (frames > 0 && !batch.swept.empty())
    text += "Sensors and truth are those of the first run; the keys above may change them.\n\n";
  text += "## How to make it again\n\n    rubble remake " + run + "/manifest.json --out again\n\nmakes one run; each manifest holds the mission, its seed and every key. "
          "`sha256sum -c SHA256SUMS` checks every file.\n";
  return text + make_card_licence(given.licence);
}

std::string make_batch_checksums(const FinishedBatch& batch, const std::map<std::string, std::string>& further) {
  std::string lines;
  for (const char* name : {"batch.json", "index.csv"})
    lines += sha256_of_file(batch.folder + "/" + name) + "  " + name + "\n";
  for (const auto& [name, text] : further) lines += sha256(text) + "  " + name + "\n";
  for (const auto& row : batch.table.rows) {
    if (!has_dataset(batch, row)) continue;
    const std::string run = batch.run_of(row);
    lines += make_checksums(open_finished_run(batch.folder + "/" + run), {}, run + "/");
  }
  return lines;
}

}  // namespace rubble
