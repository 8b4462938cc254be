// Where the runs of a batch lie, and how far each is. A run has a name: Sweep::run_name.
#pragma once

#include <string>

namespace rubble {

enum class RunState {
  missing,     // not begun, or killed before it had read its mission
  unfinished,  // `rubble resume` continues it
  failed,      // the last attempt failed: a log says why
  done,
};

class BatchFolder {
 public:
  explicit BatchFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string of(const std::string& run) const { return path_ + "/" + run; }
  std::string failure_log(const std::string& run) const;
  // Where its log goes while it runs.
  std::string running_log(const std::string& run) const;
  RunState state_of(const std::string& run) const;
  // Whether another process holds the lock of its folder.
  bool is_at_work(const std::string& run) const;

  // Creates the folder and writes batch.json, or compares with the one that is there. Throws
  // InputError when another batch is in it. description: JSON.
  void open(const std::string& description) const;
  // After a run has ended: keeps its log if it failed, and removes it otherwise.
  void file_log(const std::string& run, bool failed) const;

 private:
  std::string path_;
};

}  // namespace rubble
