#include "app/provenance/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#include "kernel/base/error.h"
#include "kernel/base/system/output_files.h"

namespace rubble {

namespace {

std::int64_t now_ms() {
  using std::chrono::duration_cast, std::chrono::milliseconds, std::chrono::steady_clock;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

FolderLock::FolderLock(const std::string& file, Wait wait, const std::string& message) {
  const std::int64_t end = now_ms() + 10'000;
  while (true) {
    open_file(file);
    if (!lock_before(end, wait)) {
      close(descriptor_);
      throw InputError({file, 0, "", message, "", "", "wait for it, or stop it"});
    }
    if (is_still(file)) return;
    close(descriptor_);
  }
}

// Another process that ends may remove the folder between its creation and this: then it is made again.
void FolderLock::open_file(const std::string& file) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (descriptor_ >= 0 || errno != ENOENT) break;
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    make_output_folder(folder.string());
    errno = ENOENT;
  }
  if (descriptor_ < 0)
    throw RunError("cannot create " + file + ": " + std::generic_category().message(errno));
}

bool FolderLock::lock_before(std::int64_t end_ms, Wait wait) {
  while (flock(descriptor_, wait == Wait::yes ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return true;  // no locks on this file system
    if (now_ms() > end_ms && wait == Wait::briefly) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

bool FolderLock::is_still(const std::string& file) const {
  struct stat mine {}, there {};
  return fstat(descriptor_, &mine) == 0 && lstat(file.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

bool FolderLock::is_held(const std::string& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return held;
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace rubble
