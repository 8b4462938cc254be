#include "kernel/base/system/output_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <thread>

#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr int kMostTries = 100;  // of one who finds the file of another writer again and again
constexpr int kUnfollowed = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;

// strerror is not safe among threads.
std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail(const char* what, const std::string& path, int error) {
  throw RunError(std::string("cannot ") + what + " " + path + ": " + reason(error));
}

[[noreturn]] void refuse(const std::string& path, const std::string& message, const std::string& expected) {
  throw InputError({path, 0, "", message, expected, "", "remove it, or choose another output folder"});
}

// Whether another writer holds it. A file system without locks says no.
bool is_locked(int descriptor) { return flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

// Removes what has the name. A writer that died leaves an unlocked file.
void make_way(const std::string& path) {
  const int left = open(path.c_str(), O_RDONLY | kUnfollowed);
  struct stat status {};
  const bool file = left >= 0 && fstat(left, &status) == 0 && S_ISREG(status.st_mode);
  if (file && is_locked(left)) {
    close(left);
    throw RunError("cannot write " + path + ": another process is writing it; wait until it ends");
  }
  // Between the opening and the lock another writer may have put its own file there: that one stays.
  const bool replaced = file && !is_file_at(left, path);
  const bool failed = !replaced && unlink(path.c_str()) != 0 && errno != ENOENT;
  const int error = errno;
  if (left >= 0) close(left);
  if (failed) fail("create", path, error);
}

bool is_plain_name(const std::string& part) { return !part.empty() && part != "." && part != ".."; }

}  // namespace

bool is_file_at(int descriptor, const std::string& path) {
  struct stat mine {}, there {};
  return fstat(descriptor, &mine) == 0 && lstat(path.c_str(), &there) == 0 && mine.st_dev == there.st_dev &&
         mine.st_ino == there.st_ino;
}

int create_output_file(const std::string& path) {
  check_may_write(path);
  for (int i = 0; i < kMostTries; ++i) {
    const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | kUnfollowed, 0666);
    if (descriptor < 0 && errno != EEXIST) fail("create", path, errno);
    if (descriptor < 0) {
      make_way(path);
      continue;
    }
    if (!is_locked(descriptor) && is_file_at(descriptor, path)) return descriptor;
    close(descriptor);  // another writer took it for one that was left
  }
  throw RunError("cannot create " + path + ": other processes write it all the time");
}

// Another that makes the same log holds it for a moment only.
int create_log_file(const std::string& path) {
  for (int i = 0;; ++i) {
    try {
      const int descriptor = create_output_file(path);
      flock(descriptor, LOCK_UN);
      return descriptor;
    } catch (const RunError&) {
      if (i == kMostTries) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

void write_all(int descriptor, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write", path, written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(std::size_t(written));
  }
}

AppendedFile::AppendedFile(const std::string& path) : path_(path) {
  check_may_write(path);
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | kUnfollowed, 0666);
  if (descriptor_ < 0 && errno == ELOOP) refuse(path, "is a link", "a file");
  if (descriptor_ < 0 && errno == EISDIR) refuse(path, "is a folder", "a file");
  if (descriptor_ < 0) fail("open", path, errno);
  struct stat status {};
  if (fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1) return;
  close(descriptor_);
  refuse(path, S_ISREG(status.st_mode) ? "has a second name elsewhere (a hard link)" : "is a pipe or a device", "a file");
}

AppendedFile::~AppendedFile() { close(descriptor_); }

std::string AppendedFile::read_all() const {
  std::string bytes, block(1 << 16, '\0');
  for (;;) {
    const ssize_t count = pread(descriptor_, block.data(), block.size(), off_t(bytes.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("read", path_, errno);
    if (count == 0) return bytes;
    bytes.append(block.data(), std::size_t(count));
  }
}

void AppendedFile::cut(std::uint64_t size) {
  if (ftruncate(descriptor_, off_t(size)) != 0) fail("shorten", path_, errno);
}

void AppendedFile::append(std::string_view bytes) { write_all(descriptor_, bytes, path_); }

void make_output_folder(const std::string& folder) {
  if (folder.empty()) return;  // of a plain file name
  check_may_write(folder);
  std::error_code failed;
  const fs::file_status status = fs::status(folder, failed);
  if (fs::exists(status) && !fs::is_directory(status))
    throw InputError({folder, 0, "", "is not a folder", "", "", "choose another output folder"});
  fs::create_directories(folder, failed);
  if (failed) throw RunError("cannot create the folder " + folder + ": " + failed.message());
}

std::string make_folder_below(const std::string& folder, const std::string& name) {
  check_may_write(folder);
  std::string path = folder;
  for (std::size_t begin = 0, end = 0; begin <= name.size(); begin = end + 1) {
    end = std::min(name.find('/', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    path += "/" + part;
    if (!is_plain_name(part)) refuse(path, "leaves the output folder", "the name of a folder");
    struct stat status {};
    if (mkdir(path.c_str(), 0777) == 0) continue;
    const int error = errno;
    if (error != EEXIST) fail("create the folder", path, error);
    if (lstat(path.c_str(), &status) != 0) fail("create the folder", path, errno);
    if (S_ISLNK(status.st_mode)) refuse(path, "is a link", "a folder");
    if (!S_ISDIR(status.st_mode)) refuse(path, "is not a folder", "a folder");
  }
  return path;
}

int create_locked_folder(const std::string& path) {
  check_may_write(path);
  for (int i = 0; i < kMostTries; ++i) {
    const int left = open(path.c_str(), O_RDONLY | O_DIRECTORY | kUnfollowed);
    const bool busy = left >= 0 && is_locked(left);
    if (!busy) remove_output_folder(path);
    if (left >= 0) close(left);
    if (busy) throw RunError("cannot write " + path + ": another process is writing it; wait until it ends");
    if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) fail("create", path, errno);
    const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | kUnfollowed);
    if (descriptor < 0) continue;
    if (!is_locked(descriptor) && is_file_at(descriptor, path)) return descriptor;
    close(descriptor);
  }
  throw RunError("cannot create " + path + ": other processes write it all the time");
}

std::string make_private_folder(const std::string& parent, const std::string& name) {
  std::string path = (fs::path(parent) / (name + "-XXXXXX")).string();
  if (!mkdtemp(path.data())) fail("create a folder such as", path, errno);
  return path;
}

bool remove_output_file(const std::string& path) { return unlink(path.c_str()) == 0; }

void remove_output_folder(const std::string& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

}  // namespace rubble
