#include "app/look_over.h"

#include <cstdio>
#include <filesystem>

#include "app/commands.h"
#include "app/disk_estimate.h"
#include "app/manifest.h"
#include "app/run_folder.h"
#include "io/atomic_file.h"
#include "io/recording_check.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVerdictNames[] = {"sound", "altered", "missing", "not checked"};

std::string describe_content(const RecordingCheck& check) {
  std::int64_t messages = 0;
  for (const auto& item : check.messages) messages += item.second;
  if (check.messages.empty()) return check.kind;
  return check.kind + ", " + std::to_string(messages) + " messages of " +
         std::to_string(check.messages.size()) + " topics";
}

std::string size_of(const std::string& path) {
  std::error_code failed;
  return ", " + format_bytes(fs::file_size(path, failed));
}

void print_row(const std::string& name, const FileReport& report) {
  std::printf("%-24s %-12s %s\n", name.c_str(), kVerdictNames[int(report.verdict)],
              report.detail.c_str());
}

bool is_sound(FileVerdict verdict) {
  return verdict == FileVerdict::sound || verdict == FileVerdict::not_checked;
}

// What the manifest beside a file states for it.
std::optional<std::string> stated_hash(const std::string& path) {
  const std::string manifest = (fs::path(path).parent_path() / "manifest.json").string();
  std::error_code failed;
  if (!fs::exists(manifest, failed)) return std::nullopt;
  const auto outputs = manifest_from_json(read_whole_file(manifest), manifest).outputs;
  const auto found = outputs.find(fs::path(path).filename().string());
  if (found == outputs.end()) return std::nullopt;
  return found->second;
}

void print_summary(const Manifest& m) {
  std::printf("script                   %s, seed %llu, by rubble %s (%s)\n",
              m.recipe.script.path.c_str(), static_cast<unsigned long long>(m.seed),
              m.program.version.c_str(), m.program.commit.c_str());
  std::printf("pile                     %lld pieces, %s, state hash %s\n",
              static_cast<long long>(m.pile.pieces), m.pile.settled ? "at rest" : "not at rest",
              m.pile.state_hash.c_str());
  std::printf("frames                   %zu\n", m.frames.frames.size());
}

bool print_folder(const std::string& folder) {
  const std::string file = folder + "/manifest.json";
  std::error_code failed;
  if (!fs::exists(file, failed) && is_unfinished(folder)) {
    std::printf("unfinished: `rubble resume %s` continues it\n", folder.c_str());
    return true;
  }
  const std::string text = read_whole_file(file);
  const Manifest manifest = manifest_from_json(text, file);
  print_summary(manifest);
  const auto altered = find_altered_parts(text, file);
  for (const std::string& sentence : altered)
    print_row("manifest.json", {FileVerdict::altered, sentence});
  bool sound = altered.empty();
  for (const auto& [name, hash] : manifest.outputs) {
    const FileReport report = look_over_file(folder + "/" + name, hash);
    print_row(name, report);
    sound = sound && is_sound(report.verdict);
  }
  return sound;
}

}  // namespace

FileReport look_over_file(const std::string& path, const std::optional<std::string>& hash) {
  std::error_code failed;
  if (hash && !fs::is_regular_file(path, failed)) return {FileVerdict::missing, ""};
  const auto check = check_recording(path);
  if (check && check->fault)
    return {FileVerdict::altered,
            "at byte " + std::to_string(check->fault->byte) + ": " + check->fault->what};
  const std::string content = (check ? describe_content(*check) : "file") + size_of(path);
  if (!hash) return {check ? FileVerdict::sound : FileVerdict::not_checked, content};
  if (sha256_of_file(path) == *hash) return {FileVerdict::sound, content};
  return {FileVerdict::altered,
          "its SHA-256 is not the manifest's; `rubble verify` finds the first byte"};
}

bool print_report(const std::string& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) return print_folder(path);
  if (!fs::exists(path, failed))
    throw InputError(
        {path, 0, "", "no such file or folder", "a recording, or the folder of a run", "", ""});
  if (!fs::is_regular_file(path, failed))
    throw InputError({path, 0, "", "is no file that can be looked into", "a file or a folder",
                      "a pipe or a device", ""});
  const FileReport report = look_over_file(path, stated_hash(path));
  print_row(path, report);
  return is_sound(report.verdict);
}

ExitCode print_info_of(const std::vector<std::string>& paths) {
  bool sound = true;
  for (const std::string& path : paths) sound = print_report(path) && sound;
  return sound ? ExitCode::done : ExitCode::differs;
}

}  // namespace rubble
