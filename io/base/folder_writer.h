// A folder of many files that has its final name only when all of them are there.
//
// The files are made on several threads and written, in the order in which they were asked for,
// into "NAME.part"; at the end that is flushed to the disk as a whole and renamed.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/base/ordered_tasks.h"

namespace rubble {

class FolderWriter {
 public:
  // Creates "NAME.part" with `folders` in it; one left by a run that was killed is replaced. Throws
  // RunError when it cannot, when another process is writing it, or when something of the final name is there.
  FolderWriter(std::string final_path, const std::vector<std::string>& folders, int threads);
  ~FolderWriter();  // without finish(): removes everything
  FolderWriter(const FolderWriter&) = delete;
  FolderWriter& operator=(const FolderWriter&) = delete;

  // name: of the file, relative to the folder. Both throw RunError with path and reason.
  void write(const std::string& name, std::string_view bytes);
  // `make` runs on another thread: what it needs, it must hold.
  void add(const std::string& name, std::function<std::string()> make);
  // Appends to a file, in the order of the calls: what is too long for the memory. `written` is told the size on the
  // caller's thread, at the latest in wait() or finish().
  void append(const std::string& name, std::function<std::string()> make, std::function<void(std::size_t)> written);
  void append(const std::string& name, std::string bytes) {
    append(name, [bytes = std::move(bytes)] { return bytes; }, nullptr);
  }
  void wait();  // until all that was asked for is written
  void finish();  // folders without a file are left out

  const std::string& path() const { return path_; }

 private:
  std::string path_, part_;
  std::vector<std::string> folders_;
  int lock_ = -1;  // on "NAME.part"
  bool finished_ = false;
  OrderedTasks tasks_;
};

}  // namespace rubble
