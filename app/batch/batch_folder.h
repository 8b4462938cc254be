// Where the seeds of a batch lie, and how far each is.
#pragma once

#include <cstdint>
#include <string>

namespace rubble {

enum class SeedState {
  missing,     // not begun, or killed before it had read its mission
  unfinished,  // `rubble resume` continues it
  failed,      // the last attempt failed: a log says why
  done,
};

class BatchFolder {
 public:
  explicit BatchFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string of_seed(std::uint64_t seed) const { return path_ + "/seed_" + std::to_string(seed); }
  std::string failure_log(std::uint64_t seed) const;
  // Where the log of a seed goes while it runs.
  std::string running_log(std::uint64_t seed) const;
  SeedState state_of(std::uint64_t seed) const;
  // Whether another process holds the lock of its folder.
  bool is_at_work(std::uint64_t seed) const;

  // Creates the folder and writes batch.json, or compares with the one that is there. Throws
  // InputError when another batch is in it. description: JSON.
  void open(const std::string& description) const;
  // After a run has ended: keeps its log if it failed, and removes it otherwise.
  void file_log(std::uint64_t seed, bool failed) const;

 private:
  std::string path_;
};

}  // namespace rubble
