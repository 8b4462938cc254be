#include "app/provenance/run_folder.h"

#include <filesystem>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "app/provenance/earlier_files.h"
#include "app/provenance/folder_lock.h"
#include "io/base/atomic_file.h"
#include "io/base/remove_files.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileList = "/unfinished/files.txt";

// null: the run that was waited for has ended, and its folder `unfinished` with it.
std::shared_ptr<const FolderLock> lock_run(const std::string& folder) {
  try {
    return std::make_shared<const FolderLock>(folder + "/unfinished/lock",
                                              FolderLock::Wait::briefly,
                                              "another process is at work on this run");
  } catch (const RunError&) {
    std::error_code failed;
    if (fs::is_directory(folder + "/unfinished", failed)) throw;
    return nullptr;
  }
}

void refuse_unfinished(const std::string& path, bool force) {
  if (is_unfinished(path) && !force)
    throw InputError({path, 0, "", "an unfinished run is in the output folder", "", "",
                      "`rubble resume " + path + "` continues it; --force starts anew"});
}

// Only what a process that was killed before it could say what it is has left there.
bool holds_nothing_but_unfinished(const std::string& path) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(path, failed))
    if (entry.path().filename() != "unfinished") return false;
  return !failed;
}

std::string pile_note(const RunFolder& folder, std::uint64_t work) {
  return hex64(work) + " " + sha256_of_file(folder.file("pile.bin"));
}

}  // namespace

bool is_unfinished(const std::string& folder) {
  std::error_code failed;
  return fs::is_regular_file(folder + "/unfinished/run.json", failed);
}

// Whoever waited for the lock looks again: what was there may be finished, or begun, by now.
RunFolder RunFolder::create(const std::string& path, bool force) {
  allow_output(path);
  refuse_unfinished(path, force);
  std::error_code failed;
  const bool left = fs::is_directory(path + "/unfinished", failed);
  if (!left) prepare_output_folder(path, force, {});
  RunFolder folder(path);
  while (!folder.lock_) {
    make_folder_below(path, "unfinished");
    folder.lock_ = lock_run(path);
  }
  refuse_unfinished(path, force);
  const std::vector<std::string> files = force ? files_of_earlier_run(path) : usual_run_files();
  if (!holds_nothing_but_unfinished(path)) prepare_output_folder(path, force, files);
  clear_unfinished(path);
  remove_empty_parents(path, files);
  if (force) refuse_foreign_recordings(path);
  return folder;
}

RunFolder RunFolder::open_unfinished(const std::string& path) {
  allow_output(path);
  if (is_unfinished(path)) {
    make_folder_below(path, "unfinished");  // which is there: it must be no link
    RunFolder folder(path);
    folder.lock_ = lock_run(path);
    if (folder.lock_ && is_unfinished(path)) return folder;
  }
  std::error_code failed;
  if (!fs::is_directory(path, failed))
    throw InputError({path, 0, "", "no such folder", "the output folder of a run", "", ""});
  if (fs::exists(path + "/manifest.json", failed)) {
    // Killed between its last two steps, the run left its notes.
    if (fs::is_directory(path + "/unfinished", failed)) remove_unfinished(path);
    throw InputError({path, 0, "", "the run in it is finished; nothing is left to do", "", "",
                      "`rubble verify " + path + "` checks it"});
  }
  throw InputError({path, 0, "", "there is no unfinished run in this folder", "", "",
                    "if the run was killed before it had read its mission, start it again with `rubble run`"});
}

void RunFolder::note_pile(std::uint64_t work, const DeepestOverlap& overlap) const {
  write_text_file(file("unfinished/settled.txt"), pile_note(*this, work) + "\n" + exact_text(overlap.depth) + " " +
                                                      std::to_string(overlap.piece_a) + " " + std::to_string(overlap.piece_b) + "\n");
}

DeepestOverlap RunFolder::noted_overlap() const {
  std::istringstream words(read_whole_file(file("unfinished/settled.txt")));
  std::string pile;
  std::getline(words, pile);
  DeepestOverlap overlap;
  words.imbue(std::locale::classic());
  words >> overlap.depth >> overlap.piece_a >> overlap.piece_b;
  return words ? overlap : DeepestOverlap();
}

bool RunFolder::has_pile_of(std::uint64_t work) const {
  if (!has("pile.bin") || !has("unfinished/settled.txt")) return false;
  return read_whole_file(file("unfinished/settled.txt")).rfind(pile_note(*this, work) + "\n", 0) == 0;
}

bool RunFolder::has(const std::string& name) const {
  std::error_code failed;
  return fs::exists(file(name), failed);
}

void RunFolder::begin(const std::string& run_json) {
  write_text_file(run_file(), run_json);
}

void RunFolder::expect(const std::vector<std::string>& names) const {
  std::string lines;
  for (const std::string& name : names) lines += name + "\n";
  AppendedFile(path_ + kFileList).append(lines);
}

// run.json goes first: without it nothing is unfinished.
void RunFolder::finish() const {
  remove_output_file(run_file());
  if (is_unfinished(path_)) throw RunError("cannot remove " + run_file());
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
