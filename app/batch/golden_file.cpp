#include "app/batch/golden_file.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

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

}  // namespace

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

std::vector<std::string> GoldenFile::update(const std::string& run, const GoldenHashes& found) {
  std::vector<std::string> diff;
  GoldenHashes& known = runs_[run];
  for (const auto& [name, hash] : known)
    if (!found.count(name) || found.at(name) != hash)
      diff.push_back("- " + run + " " + name + " " + hash);
  for (const auto& [name, hash] : found)
    if (!known.count(name) || known.at(name) != hash)
      diff.push_back("+ " + run + " " + name + " " + hash);
  known = found;
  if (known.empty()) runs_.erase(run);
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
    it = runs_.erase(it);
  }
  return diff;
}

void GoldenFile::save() const {
  Json json;
  json["format"] = kFormat;
  json["runs"] = runs_;
  write_text_file(path_, json.dump(2) + "\n");
}

}  // namespace rubble
