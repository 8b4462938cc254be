#include "app/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "kernel/base/error.h"

namespace rubble {

FolderLock::FolderLock(const std::string& file, Wait wait, const std::string& message) {
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw RunError("cannot create " + file + ": " + std::generic_category().message(errno));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (flock(descriptor_, wait == Wait::yes ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return;
    if (std::chrono::steady_clock::now() > end && wait == Wait::briefly) {
      close(descriptor_);
      throw InputError({file, 0, "", message, "", "", "wait for it, or stop it"});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

bool FolderLock::is_held(const std::string& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return held;
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace rubble
