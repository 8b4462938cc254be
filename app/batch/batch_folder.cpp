#include "app/batch/batch_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/provenance/compare.h"
#include "app/provenance/folder_lock.h"
#include "app/provenance/run_folder.h"
#include "app/support/json_members.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

void create_folder(const std::string& path) {
  std::error_code failed;
  if (fs::exists(path, failed) && !fs::is_directory(path, failed))
    throw InputError({path, 0, "--out", "is not a folder", "", "", "choose another output folder"});
  fs::create_directories(path, failed);
  if (failed) throw RunError("cannot create the folder " + path + ": " + failed.message());
}

}  // namespace

std::string BatchFolder::failure_log(std::uint64_t seed) const {
  return path_ + "/failed/seed_" + std::to_string(seed) + ".log";
}

std::string BatchFolder::running_log(std::uint64_t seed) const {
  return path_ + "/running/seed_" + std::to_string(seed) + ".log";
}

SeedState BatchFolder::state_of(std::uint64_t seed) const {
  std::error_code error;
  const bool unfinished = is_unfinished(of_seed(seed));
  if (!unfinished && fs::exists(of_seed(seed) + "/manifest.json", error)) return SeedState::done;
  if (fs::exists(failure_log(seed), error)) return SeedState::failed;
  return unfinished ? SeedState::unfinished : SeedState::missing;
}

bool BatchFolder::is_at_work(std::uint64_t seed) const {
  return FolderLock::is_held(of_seed(seed) + "/unfinished/lock");
}

void BatchFolder::open(const std::string& description) const {
  create_folder(path_);
  const std::string file = path_ + "/batch.json";
  const FolderLock lock(path_ + "/batch.lock", FolderLock::Wait::yes);
  std::error_code failed;
  if (fs::exists(file, failed)) {
    const std::string apart = describe_difference(parse_json_text(read_whole_file(file), file),
                                                  parse_json_text(description, "this batch"));
    if (!apart.empty())
      throw InputError({path_, 0, "--out", "another batch is in the output folder: " + apart, "",
                        "", "choose another folder, or run what was begun there"});
    return;
  }
  if (!fs::is_empty(path_, failed) && fs::exists(path_ + "/manifest.json", failed))
    throw InputError({path_, 0, "--out", "a single run is in the output folder", "", "",
                      "choose another folder"});
  create_folder(path_ + "/failed");
  create_folder(path_ + "/running");
  write_text_file(file, description);
}

void BatchFolder::file_log(std::uint64_t seed, bool failed) const {
  std::error_code ignored;
  if (failed) {
    fs::rename(running_log(seed), failure_log(seed), ignored);
  } else {
    fs::remove(running_log(seed), ignored);
    fs::remove(failure_log(seed), ignored);
  }
}

}  // namespace rubble
