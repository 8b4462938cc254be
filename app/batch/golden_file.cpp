#include "app/batch/golden_file.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/provenance/compare.h"
#include "app/support/json_members.h"
#include "io/base/atomic_file.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "rubble golden 1";

std::string hash_of_frames(const FrameHashes& frames) {
  std::string text;
  for (const std::string& channel : frames.channels) text += channel + " ";
  for (const auto& hashes : frames.frames) text += "\n" + format_hashes(hashes);
  return sha256(text);
}

Json json_of(const GoldenDetails& details) {
  Json json{{"pieces", details.pieces}};
  if (details.frames.frames.empty()) return json;
  json["channels"] = details.frames.channels;
  json["frames"] = Json::array();
  for (const auto& hashes : details.frames.frames) json["frames"].push_back(format_hashes(hashes));
  return json;
}

GoldenDetails read_details(const JsonMembers& json) {
  GoldenDetails details;
  for (const auto& [name, value] : json.members()) {
    if (name == "pieces") details.pieces = value.as_text();
    if (name == "channels")
      for (const JsonMembers& channel : json.list(name)) details.frames.channels.push_back(channel.as_text());
    if (name != "frames") continue;
    for (const JsonMembers& row : json.list(name)) {
      details.frames.frames.emplace_back();
      if (!parse_hashes(row.as_text(), details.frames.frames.back())) json.fail(name, "hashes of frames");
    }
  }
  return details;
}

}  // namespace

GoldenDetails golden_details(const Manifest& manifest, const PileState& pile, GoldenParts parts) {
  GoldenDetails details;
  if (parts == GoldenParts::none) return details;
  details.pieces = digest_pieces(pile);
  if (parts == GoldenParts::all) details.frames = manifest.frames;
  return details;
}

GoldenHashes golden_hashes(const Manifest& manifest, GoldenParts parts) {
  GoldenHashes hashes;
  if (parts == GoldenParts::none) return hashes;
  hashes["state_hash"] = manifest.pile.state_hash;
  if (parts == GoldenParts::pile) return hashes;
  if (!manifest.frames.frames.empty()) hashes["frames"] = hash_of_frames(manifest.frames);
  hashes.insert(manifest.outputs.begin(), manifest.outputs.end());
  return hashes;
}

GoldenFile::GoldenFile(const std::string& path) : path_(path) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) return;
  const Json json = parse_json_text(read_whole_file(path), path);
  const JsonMembers members(json, path);
  if (members.text("format") != kFormat) members.fail("format", kFormat);
  for (const auto& [run, hashes] : members.object("runs").members())
    for (const auto& [name, hash] : hashes.members()) runs_[run][name] = hash.as_text();
  if (!json.contains("details")) return;
  for (const auto& [run, details] : members.object("details").members())
    details_[run] = read_details(details);
}

std::vector<std::string> GoldenFile::compare(const std::string& run,
                                             const GoldenHashes& found) const {
  std::vector<std::string> sentences;
  const auto known = runs_.find(run);
  if (known == runs_.end() && !found.empty())
    return {"the golden file has no hashes of this run; --update takes them"};
  for (const auto& [name, hash] : found) {
    if (!known->second.count(name))
      sentences.push_back(name + " is not in the golden file; --update takes it");
    else if (known->second.at(name) != hash)
      sentences.push_back(name + " is " + hash + " instead of " + known->second.at(name));
  }
  if (known == runs_.end()) return sentences;
  for (const auto& item : known->second)
    if (!found.count(item.first)) sentences.push_back(item.first + " is not there any more");
  return sentences;
}

std::vector<std::string> GoldenFile::find_first(const std::string& run, const PileState& pile,
                                                const FrameHashes& frames) const {
  std::vector<std::string> sentences;
  const auto known = details_.find(run);
  if (known == details_.end()) return sentences;
  const std::string piece = known->second.pieces.empty() ? "" : describe_first_piece(known->second.pieces, pile);
  if (!piece.empty()) sentences.push_back(piece);
  if (known->second.frames.frames.empty()) return sentences;
  const FrameDifference apart = find_difference(known->second.frames, frames);
  if (!apart.why.empty()) sentences.push_back(apart.why);
  return sentences;
}

std::vector<std::string> GoldenFile::update(const std::string& run, const GoldenHashes& found,
                                            const GoldenDetails& details) {
  std::vector<std::string> diff;
  GoldenHashes& known = runs_[run];
  for (const auto& [name, hash] : known)
    if (!found.count(name) || found.at(name) != hash)
      diff.push_back("- " + run + " " + name + " " + hash);
  for (const auto& [name, hash] : found)
    if (!known.count(name) || known.at(name) != hash)
      diff.push_back("+ " + run + " " + name + " " + hash);
  known = found;
  details_[run] = details;
  if (known.empty()) runs_.erase(run), details_.erase(run);
  return diff;
}

std::vector<std::string> GoldenFile::keep_only(const std::vector<std::string>& runs) {
  std::vector<std::string> diff;
  for (auto it = runs_.begin(); it != runs_.end();) {
    if (std::find(runs.begin(), runs.end(), it->first) != runs.end()) {
      ++it;
      continue;
    }
    for (const auto& [name, hash] : it->second)
      diff.push_back("- " + it->first + " " + name + " " + hash);
    details_.erase(it->first);
    it = runs_.erase(it);
  }
  return diff;
}

void GoldenFile::save() const {
  Json json;
  json["format"] = kFormat;
  json["runs"] = runs_;
  for (const auto& [run, details] : details_) json["details"][run] = json_of(details);
  write_text_file(path_, json.dump(2) + "\n");
}

}  // namespace rubble
