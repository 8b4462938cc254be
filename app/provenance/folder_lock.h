// One process at a time in a folder, also among the machines that share it.
#pragma once

#include <cstdint>
#include <string>

namespace rubble {

class FolderLock {
 public:
  enum class Wait {
    briefly,  // ten seconds: a process that was told to stop may be about to
    yes,
  };
  // Locks FILE, which is created; if whoever held it removed it meanwhile, the one that is there now.
  // Throws InputError with `message` when another process holds it after waiting briefly, RunError
  // when it cannot be created. A file system without locks is not an error: then there is no
  // protection.
  FolderLock(const std::string& file, Wait wait, const std::string& message = "");
  ~FolderLock();
  // Whether a process holds it now.
  static bool is_held(const std::string& file);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void open_file(const std::string& file);
  bool lock_before(std::int64_t end_ms, Wait wait);  // gives whether it is held
  bool is_still(const std::string& file) const;

  int descriptor_ = -1;
};

}  // namespace rubble
