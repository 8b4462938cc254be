// One process at a time in a folder, also among the machines that share it.
#pragma once

#include <string>

namespace rubble {

class FolderLock {
 public:
  enum class Wait {
    briefly,  // ten seconds: a process that was told to stop may be about to
    yes,
  };
  // Locks FILE, which is created. Throws InputError with `message` when another process holds it
  // after waiting briefly. A file system without locks is not an error: then there is no
  // protection.
  FolderLock(const std::string& file, Wait wait, const std::string& message = "");
  ~FolderLock();
  // Whether a process holds it now.
  static bool is_held(const std::string& file);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace rubble
