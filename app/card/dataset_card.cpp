#include "app/card/dataset_card.h"

#include <filesystem>
#include <vector>

#include "app/card/card_parts.h"
#include "app/estimate/disk_estimate.h"
#include "kernel/base/hash.h"
#include "kernel/base/text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::string files(const FinishedRun& saved) {
  std::string text = "## Files\n\n| file | size | SHA-256 |\n| --- | --- | --- |\n";
  std::uint64_t sum = 0, small = 0, count = 0;
  for (const auto& [name, hash] : saved.manifest.outputs) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(saved.folder + "/" + name, failed);
    if (failed) continue;
    sum += size;
    if (name.find('/') != std::string::npos) {
      small += size, ++count;  // of a folder of pictures: one line for all
      continue;
    }
    text += "| `" + table_cell(name) + "` | " + format_bytes(size) + " | `" + hash.substr(0, 16) + "...` |\n";
  }
  if (count > 0)
    text += "| " + std::to_string(count) + " files in folders | " + format_bytes(small) + " | |\n";
  return text + "\n" + format_bytes(sum) + " in all. `sha256sum -c SHA256SUMS` checks every file.\n\n";
}

std::string metrics(const Manifest& manifest) {
  std::string text = "## Figures\n\n| metric | value |\n| --- | --- |\n";
  for (const auto& [name, value] : manifest.metrics) text += table_row("`" + name + "`", format_number(value));
  return text + "\n";
}

}  // namespace

std::string make_dataset_card(const FinishedRun& saved, const CardText& given) {
  const Manifest& m = saved.manifest;
  const Scenario s = stated_scenario(m.provenance);
  const std::string title = given.title.empty()
                                ? printable(m.provenance.script.path) + ", seed " + std::to_string(m.seed)
                                : printable(given.title);
  const bool flown = !m.frames.frames.empty();
  std::string text = make_card_head(title, given.licence);
  text += std::to_string(m.pile.pieces) + " pieces of a collapsed structure, " +
          std::string(m.pile.settled ? "at rest" : "which had not come to rest") +
          ", simulated by Rubble " + printable(m.program.version) + " (" + printable(m.program.commit) +
          ") from seed " + std::to_string(m.seed) + ".\n\n";
  if (flown) text += describe_sensors(s, m.frames.frames.size());
  text += describe_truth(s, flown) + files(saved) + metrics(m);
  text += "## How to make it again\n\n    rubble remake manifest.json --out again\n\nThe manifest holds the mission, "
          "its seed and every key; state hash `" + m.pile.state_hash + "`. Packs are found by content:\n\n";
  std::vector<std::string> packs;
  for (const AssetContent& asset : m.provenance.assets)
    if (packs.empty() || packs.back() != asset.pack) packs.push_back(asset.pack);
  for (const std::string& pack : packs) text += "- `" + table_cell(pack) + "`\n";
  return text + "\n" + describe_split(m.seed, given.shares) + make_card_licence(given.licence);
}

std::string make_checksums(const FinishedRun& saved, const std::map<std::string, std::string>& further,
                           const std::string& before) {
  std::map<std::string, std::string> sums = saved.manifest.outputs;
  sums["manifest.json"] = sha256_of_file(saved.folder + "/manifest.json");
  for (const auto& [name, text] : further) sums[name] = sha256(text);
  std::string lines;
  for (const auto& [name, hash] : sums) lines += hash + "  " + before + name + "\n";
  return lines;
}

}  // namespace rubble
