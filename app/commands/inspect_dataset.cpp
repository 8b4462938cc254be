#include "app/commands/inspect_dataset.h"

#include <filesystem>
#include <map>

#include "app/batch/batch_folder.h"
#include "app/batch/seed_list.h"
#include "app/batch/sweep.h"
#include "app/estimate/disk_estimate.h"
#include "app/provenance/manifest.h"
#include "app/provenance/run_folder.h"
#include "app/support/json_members.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"
#include "io/playback/recording_check.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileVerdictNames[] = {"sound", "altered", "missing", "not checked"};

std::string describe_content(const RecordingCheck& check) {
  std::int64_t messages = 0;
  for (const auto& item : check.messages) messages += item.second;
  if (check.messages.empty()) return check.kind;
  return check.kind + ", " + std::to_string(messages) + " messages of " +
         std::to_string(check.messages.size()) + " topics";
}

std::uint64_t size_of(const std::string& path) {
  std::error_code failed;
  const std::uint64_t size = fs::file_size(path, failed);
  return failed ? 0 : size;
}

void print_row(const std::string& name, const FileReport& report) {
  print_out("%-24s %-12s %s\n", name.c_str(), kFileVerdictNames[int(report.verdict)],
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
  print_out("script                   %s, seed %llu, by rubble %s (%s)\n",
            m.provenance.script.path.c_str(), static_cast<unsigned long long>(m.seed),
            m.program.version.c_str(), m.program.commit.c_str());
  print_out("pile                     %lld pieces, %s, state hash %s\n",
            static_cast<long long>(m.pile.pieces), m.pile.settled ? "at rest" : "not at rest",
            m.pile.state_hash.c_str());
  print_out("frames                   %zu\n", m.frames.frames.size());
}

// The files of a recording that is a folder, as one row; those that are not sound have one each.
class FileTable {
 public:
  void add(const std::string& name, const FileReport& report) {
    sound_ = sound_ && is_sound(report.verdict);
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos || !is_sound(report.verdict)) return print_row(name, report);
    Group& group = groups_[name.substr(0, slash + 1)];
    ++group.files;
    group.bytes += report.bytes;
  }
  // Prints what was not printed yet. Whether all is sound.
  bool finish() const {
    for (const auto& [name, group] : groups_)
      print_row(name, {FileVerdict::sound,
                       std::to_string(group.files) + (group.files == 1 ? " file, " : " files, ") +
                           format_bytes(group.bytes)});
    return sound_;
  }

 private:
  struct Group {
    std::size_t files = 0;
    std::uint64_t bytes = 0;
  };
  std::map<std::string, Group> groups_;
  bool sound_ = true;
};

// How far a batch is; whether a seed's dataset is whole is asked of its own folder.
bool print_batch(const std::string& folder) {
  const std::string file = folder + "/batch.json";
  const auto json = parse_json_text(read_whole_file(file), file);
  const JsonMembers members(json, file);
  const std::string seeds = members.text("seeds");
  const BatchFolder batch(folder);
  std::vector<std::string> varied;
  if (json.contains("vary"))
    for (const JsonMembers& text : members.list("vary")) varied.push_back(text.as_text());
  const Sweep sweep =
      make_sweep(varied, json.contains("samples") ? int(members.integer("samples")) : 0);
  std::map<RunState, std::vector<std::string>> by_state;
  for (std::size_t variant = 0; variant < sweep.variants.size(); ++variant)
    for (const std::uint64_t seed : parse_seeds(seeds, "seeds")) {
      const std::string number = std::to_string(seed), name = sweep.run_name(variant, number);
      by_state[batch.state_of(name)].push_back(sweep.varies() ? name : "seed " + number);
    }
  print_out("batch                    %s, seeds %s\n",
            printable(members.object("script").text("name")).c_str(), seeds.c_str());
  for (const auto& [state, name] :
       {std::pair(RunState::done, "done"), std::pair(RunState::failed, "failed"),
        std::pair(RunState::unfinished, "unfinished"), std::pair(RunState::missing, "not begun")}) {
    const std::vector<std::string>& of = by_state[state];
    std::string first;
    for (std::size_t i = 0; i < of.size() && i < 5 && state != RunState::done; ++i)
      first += (i ? ", " : ": ") + of[i];
    if (!first.empty() && of.size() > 5) first += ", ...";
    if (!of.empty()) print_out("%-24s %zu%s\n", name, of.size(), first.c_str());
  }
  std::error_code failed;
  if (fs::exists(folder + "/index.csv", failed))
    print_out("%-24s %s/index.csv\n", "table", folder.c_str());
  return by_state[RunState::failed].empty();
}

bool print_folder(const std::string& folder) {
  allow_results(folder);
  const std::string file = folder + "/manifest.json";
  std::error_code failed;
  if (!fs::exists(file, failed) && fs::exists(folder + "/batch.json", failed))
    return print_batch(folder);
  if (!fs::exists(file, failed) && is_unfinished(folder)) {
    print_out("unfinished: `rubble resume %s` continues it\n", folder.c_str());
    return true;
  }
  const std::string text = read_whole_file(file);
  const Manifest manifest = manifest_from_json(text, file);
  print_summary(manifest);
  const auto altered = find_altered_parts(text, file);
  for (const std::string& sentence : altered)
    print_row("manifest.json", {FileVerdict::altered, sentence});
  FileTable table;
  for (const auto& [name, hash] : manifest.outputs)
    table.add(name, inspect_file(folder + "/" + name, hash));
  return table.finish() && altered.empty();
}

}  // namespace

FileReport inspect_file(const std::string& path, const std::optional<std::string>& hash) {
  std::error_code failed;
  if (hash && !fs::is_regular_file(path, failed)) return {FileVerdict::missing, ""};
  const auto check = check_recording(path);
  if (check && check->fault)
    return {FileVerdict::altered,
            "at byte " + std::to_string(check->fault->byte) + ": " + check->fault->what};
  const std::uint64_t size = size_of(path);
  const std::string content =
      (check ? describe_content(*check) : "file") + ", " + format_bytes(size);
  if (!hash) return {check ? FileVerdict::sound : FileVerdict::not_checked, content, size};
  if (sha256_of_file(path) == *hash) return {FileVerdict::sound, content, size};
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
    throw InputError({path, 0, "", "cannot be inspected", "a file or a folder",
                      "a pipe or a device", ""});
  const FileReport report = inspect_file(path, stated_hash(path));
  print_row(path, report);
  return is_sound(report.verdict);
}

ExitCode inspect_datasets(const std::vector<std::string>& paths) {
  bool sound = true;
  for (const std::string& path : paths) sound = print_report(path) && sound;
  return sound ? ExitCode::done : ExitCode::differs;
}

}  // namespace rubble
