#include "app/run_folder.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "app/folder_lock.h"
#include "io/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/parallel.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFileList = "/unfinished/files.txt";

// What runs leave; the manifest comes first, for without it nothing else is taken for whole.
const std::vector<std::string> kUsualFiles{
    "manifest.json", "mission.rawlog", "mission.bag",     "mission.mcap", "pile.stl",
    "pile.bin",      "preview.png",    "groundtruth.txt", "labels.csv",   "mission.simplemap",
    "pile.ply",      "pile.obj",       "pile.mtl",        "pile.glb"};

bool is_inside(const fs::path& name) { return !name.is_absolute() && *name.begin() != ".."; }

// The files of the run that was here, as far as its manifest and its list can be read.
std::vector<std::string> files_of_earlier_run(const std::string& folder) {
  std::vector<std::string> files = kUsualFiles;
  std::ifstream list(folder + kFileList);
  for (std::string name; std::getline(list, name);)
    if (!name.empty() && is_inside(name)) files.push_back(name);
  if (!fs::is_regular_file(folder + "/manifest.json")) return files;
  const Json manifest = Json::parse(read_whole_file(folder + "/manifest.json"), nullptr, false);
  if (!manifest.is_object() || !manifest.contains("outputs")) return files;
  for (const auto& item : manifest["outputs"].items()) {
    const fs::path name = fs::path(item.key()).lexically_normal();
    if (is_inside(name)) files.push_back(name.string());  // otherwise not ours, whatever it says
  }
  return files;
}

// A run that was killed before it could say what it is left only this.
void remove_unfinished(const std::string& folder) {
  std::error_code error;
  fs::remove_all(folder + "/unfinished", error);
  if (error) throw RunError("cannot remove " + folder + "/unfinished: " + error.message());
}

void remove_empty_folders(const std::string& folder, const std::vector<std::string>& files) {
  std::error_code ignored;
  for (const std::string& file : files) {
    for (fs::path inside = fs::path(file).parent_path(); !inside.empty();
         inside = inside.parent_path())
      fs::remove(fs::path(folder) / inside, ignored);  // only when empty
  }
}

std::shared_ptr<const FolderLock> lock_run(const std::string& folder) {
  return std::make_shared<const FolderLock>(folder + "/unfinished/lock", FolderLock::Wait::briefly,
                                            "another process is at work on this run");
}

}  // namespace

bool is_unfinished(const std::string& folder) {
  std::error_code failed;
  return fs::is_regular_file(folder + "/unfinished/run.json", failed);
}

RunFolder RunFolder::create(const std::string& path, bool force) {
  if (is_unfinished(path) && !force)
    throw InputError({path, 0, "", "an unfinished run is in the output folder", "", "",
                      "`rubble resume " + path + "` continues it; --force starts anew"});
  std::error_code failed;
  const bool left = fs::is_directory(path + "/unfinished", failed);
  if (left) lock_run(path);
  if (left && !force) remove_unfinished(path);
  const std::vector<std::string> files = force ? files_of_earlier_run(path) : kUsualFiles;
  prepare_output_folder(path, force, files);
  if (left && force) remove_unfinished(path);
  remove_empty_folders(path, files);
  return RunFolder(path);
}

RunFolder RunFolder::open_unfinished(const std::string& path) {
  if (is_unfinished(path)) {
    RunFolder folder(path);
    folder.lock_ = lock_run(path);
    return folder;
  }
  std::error_code failed;
  if (!fs::is_directory(path, failed))
    throw InputError({path, 0, "", "no such folder", "the output folder of a run", "", ""});
  if (fs::exists(path + "/manifest.json", failed))
    throw InputError({path, 0, "", "the run in it is finished; nothing is left to do", "", "",
                      "`rubble verify " + path + "` checks it"});
  throw InputError({path, 0, "", "no unfinished run is in it", "", "",
                    "a run that was killed before it had read its mission is begun anew"});
}

bool RunFolder::has(const std::string& name) const {
  std::error_code failed;
  return fs::exists(file(name), failed);
}

void RunFolder::begin(const std::string& run_json) {
  std::error_code error;
  fs::create_directories(file("unfinished"), error);
  if (error) throw RunError("cannot create " + file("unfinished") + ": " + error.message());
  if (!lock_) lock_ = lock_run(path_);
  write_text_file(run_file(), run_json);
}

void RunFolder::expect(const std::vector<std::string>& names) const {
  std::ofstream list(path_ + kFileList, std::ios::app);
  for (const std::string& name : names) list << name << '\n';
}

// run.json goes first: without it nothing is unfinished.
void RunFolder::finish() const {
  std::error_code error;
  fs::remove(run_file(), error);
  if (error) throw RunError("cannot remove " + run_file() + ": " + error.message());
  remove_unfinished(path_);
}

void RunFolder::add(const std::string& name) {
  if (!fs::is_directory(file(name))) {
    hashes_[name].clear();
    return;
  }
  for (const auto& entry : fs::recursive_directory_iterator(file(name)))
    if (entry.is_regular_file()) hashes_[fs::relative(entry.path(), path_).string()].clear();
}

const std::map<std::string, std::string>& RunFolder::hash_files(int threads) {
  std::vector<std::pair<const std::string, std::string>*> left;
  for (auto& item : hashes_)
    if (item.second.empty()) left.push_back(&item);
  parallel_for(left.size(), threads,
               [&](std::size_t i) { left[i]->second = sha256_of_file(file(left[i]->first)); });
  return hashes_;
}

}  // namespace rubble
