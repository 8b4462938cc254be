#include "app/batch/batch_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/provenance/compare.h"
#include "app/provenance/folder_lock.h"
#include "app/provenance/run_folder.h"
#include "app/support/json_members.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string BatchFolder::failure_log(const std::string& run) const {
  return path_ + "/failed/" + run + ".log";
}

std::string BatchFolder::running_log(const std::string& run) const {
  return path_ + "/running/" + run + ".log";
}

RunState BatchFolder::state_of(const std::string& run) const {
  std::error_code error;
  const bool unfinished = is_unfinished(of(run));
  if (!unfinished && fs::exists(of(run) + "/manifest.json", error)) return RunState::done;
  if (fs::exists(failure_log(run), error)) return RunState::failed;
  return unfinished ? RunState::unfinished : RunState::missing;
}

bool BatchFolder::is_at_work(const std::string& run) const {
  return FolderLock::is_held(of(run) + "/unfinished/lock");
}

void BatchFolder::open(const std::string& description) const {
  allow_results(path_);
  make_output_folder(path_);
  const std::string file = path_ + "/batch.json";
  const FolderLock lock(path_ + "/batch.lock", FolderLock::Wait::yes);
  std::error_code failed;
  if (fs::exists(file, failed)) {
    const std::string apart = describe_difference(parse_json_text(read_whole_file(file), file),
                                                  parse_json_text(description, "this batch"));
    if (!apart.empty())
      throw InputError({path_, 0, "--out", "another batch is in the output folder: " + apart, "",
                        "", "choose another folder, or continue the batch in it"});
    return;
  }
  if (!fs::is_empty(path_, failed) && fs::exists(path_ + "/manifest.json", failed))
    throw InputError({path_, 0, "--out", "a single run is in the output folder", "", "",
                      "choose another folder"});
  for (const char* name : {"failed", "running"}) make_folder_below(path_, name);
  write_text_file(file, description);
}

void BatchFolder::file_log(const std::string& run, bool failed) const {
  std::error_code ignored;
  if (failed) {
    fs::rename(running_log(run), failure_log(run), ignored);
  } else {
    remove_output_file(running_log(run));
    remove_output_file(failure_log(run));
  }
}

}  // namespace rubble
