#include "app/provenance/earlier_files.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/formats/recording_formats.h"
#include "io/base/atomic_file.h"
#include "io/base/remove_files.h"
#include "io/scenes/pile_export.h"
#include "kernel/base/error.h"
#include "kernel/base/system/output_files.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// What is written as a folder.
const std::vector<std::string>& recording_folders() {
  static const std::vector<std::string> folders = [] {
    std::vector<std::string> names;
    for (const RecordingFormat& format : recording_formats())
      if (format.is_folder) names.push_back(format.leaves);
    names.push_back(kCamerasFolder);
    for (const MeshFormat& format : mesh_formats())
      if (format.is_folder) names.push_back(format.leaves.back());
    return names;
  }();
  return folders;
}

template <typename List>
bool contains(const List& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

bool is_plain_file(const std::string& path) {
  std::error_code failed;
  return fs::is_regular_file(fs::symlink_status(path, failed));
}

bool is_name_of_run(const std::string& name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) return contains(usual_run_files(), name);
  return contains(recording_folders(), name.substr(0, slash));
}

// Of unfinished/files.txt: files and, of a recording that is a folder, every plain file in it.
void add_listed(const std::string& folder, std::vector<std::string>& files) {
  const std::string path = folder + "/unfinished/files.txt";
  if (!is_plain_file(folder + "/unfinished/run.json")) return;
  // The list comes when the pile, with its exports, is there.
  std::string names;
  for (const MeshFormat& format : mesh_formats())
    if (format.is_folder) names += format.leaves.back() + "\n";
  std::istringstream list(names + (is_plain_file(path) ? read_whole_file(path) : ""));
  for (std::string name; std::getline(list, name);) {
    if (is_name_of_run(name)) files.push_back(name);
    if (!contains(recording_folders(), name)) continue;
    const std::vector<std::string> inside = list_plain_files(folder, name);
    files.insert(files.end(), inside.begin(), inside.end());
  }
}

// Of the manifest, if it can be read.
void add_stated(const std::string& folder, std::vector<std::string>& files) {
  const std::string path = folder + "/manifest.json";
  if (!is_plain_file(path)) return;
  const std::string text = read_whole_file(path);
  if (calc_json_depth(text) > kDeepestJson) return;
  const Json manifest = Json::parse(text, nullptr, false);
  if (!manifest.is_object() || !manifest.contains("outputs")) return;
  const Json& outputs = manifest["outputs"];
  if (!outputs.is_object()) return;
  for (const auto& item : outputs.items())
    if (is_name_of_run(item.key())) files.push_back(item.key());
}

bool holds_run(const fs::path& folder) {
  std::error_code failed;
  return fs::exists(folder / "manifest.json", failed) || fs::exists(folder / "unfinished/run.json", failed);
}

// Absolute, links resolved as far as there is something.
fs::path resolve(const fs::path& path) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, failed), failed);
  return whole.has_filename() ? whole : whole.parent_path();
}

// Whether a run recorded the file `name` of its folder, or files in a folder of that name.
bool is_recorded(const fs::path& run, const std::string& name) {
  if (name.rfind("unfinished/", 0) == 0) return true;
  const std::vector<std::string> files = files_of_earlier_run(run.string());
  return std::any_of(files.begin(), files.end(), [&](const std::string& file) {
    std::error_code failed;
    return (file == name || file.rfind(name + "/", 0) == 0) && fs::exists(fs::symlink_status(run / file, failed));
  });
}

// The folder of the run that recorded what is at `path`; empty: none did. path: of resolve().
fs::path find_run_of(const fs::path& path) {
  for (fs::path run = path.parent_path(); !run.empty(); run = run.parent_path()) {
    if (holds_run(run) && is_recorded(run, path.lexically_relative(run).generic_string())) return run;
    if (run == run.parent_path()) break;
  }
  return {};
}

}  // namespace

const std::vector<std::string>& usual_run_files() {
  static const std::vector<std::string> files = [] {
    std::vector<std::string> names{"manifest.json", "pile.bin", "track.bin", "track.glb", "labels.csv",
                                   "flight.json", "victims.json", "fines.bin"};
    for (const RecordingFormat& format : recording_formats())
      if (!format.is_folder) names.push_back(format.leaves);
    for (const RecordingFormat& format : recording_formats())
      if (!format.beside.empty()) names.push_back(format.beside);
    for (const MeshFormat& format : mesh_formats())
      if (!format.is_folder) names.insert(names.end(), format.leaves.begin(), format.leaves.end());
    return names;
  }();
  return files;
}

std::vector<std::string> files_of_earlier_run(const std::string& folder) {
  std::vector<std::string> files = usual_run_files();
  add_listed(folder, files);
  add_stated(folder, files);
  return files;
}

std::vector<std::string> find_derived_files(const std::string& folder) {
  std::vector<std::string> found;
  for (const char* name : {"README.md", "SHA256SUMS", "convert", "cutaway.png", "export", "settings", "view.html", "voids"}) {
    std::error_code failed;
    if (fs::exists(fs::symlink_status(fs::path(folder) / name, failed))) found.emplace_back(name);
  }
  return found;
}

void clear_unfinished(const std::string& folder) {
  const std::vector<std::string> files{"unfinished/run.json", "unfinished/settle.checkpoint",
                                       "unfinished/settle.track",
                                       "unfinished/frames.txt", "unfinished/files.txt",
                                       "unfinished/settled.txt"};
  remove_plain_files(folder, files, ".part");
  remove_plain_files(folder, files);
}

void remove_unfinished(const std::string& folder) {
  clear_unfinished(folder);
  const std::vector<std::string> lock{"unfinished/lock"};
  remove_plain_files(folder, lock);
  remove_empty_parents(folder, lock);
}

void remove_folder_of_killed_run(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) remove_output_folder(path);
}

void refuse_foreign_recordings(const std::string& folder) {
  for (const std::string& name : recording_folders()) {
    std::error_code failed;
    const fs::path path = fs::path(folder) / name;
    if (!fs::exists(fs::symlink_status(path, failed))) continue;
    const std::vector<std::string> files = list_plain_files(folder, name);
    throw InputError({path.string(), 0, "", "has files that the earlier run did not write", "",
                      files.empty() ? "" : files.front(), "move it elsewhere"});
  }
}

// What is at the path is replaced: a link by its name, not what it leads to.
void refuse_recorded_file(const std::string& path, const std::string& option) {
  std::error_code failed;
  const fs::path whole = fs::absolute(path, failed);
  const fs::path run = find_run_of(resolve(whole.parent_path()) / whole.filename());
  if (run.empty()) return;
  throw InputError({path, 0, option, "would replace a file that a run recorded", "a name that no file of the run has", "",
                    "the run is in " + run.string()});
}

void refuse_run_folder(const std::string& out, const std::string& dataset, const std::string& command) {
  const fs::path source = resolve(dataset), target = resolve(out);
  const std::string hint = "without --out the files are in " + (fs::path(dataset) / command).string();
  for (fs::path above = source; !above.empty(); above = above.parent_path()) {
    if (above == target)
      throw InputError({out, 0, "--out", "would replace the dataset that is " + command + "ed",
                        "a folder beside or below " + dataset, "", hint});
    if (above == above.parent_path()) break;
  }
  const std::string expected = "a new folder, or one of an earlier `rubble " + command + "`";
  if (holds_run(target)) throw InputError({out, 0, "--out", "would replace files of the run in it", expected, "", hint});
  if (const fs::path run = find_run_of(target); !run.empty())
    throw InputError({out, 0, "--out", "would replace files of the run in " + run.string(), expected, "", hint});
  for (const std::string& name : recording_folders())
    for (const std::string& file : list_plain_files(out, name))
      if (const fs::path inside = fs::path(out) / file; inside.filename() == "manifest.json")
        throw InputError({out, 0, "--out", "would replace files of the run in " + inside.parent_path().string(), expected, "",
                          hint});
}

}  // namespace rubble
