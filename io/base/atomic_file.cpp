#include "io/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "io/base/remove_files.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

constexpr std::size_t kBufferSize = 1 << 18;  // unit: byte

// strerror is not safe among threads; recorders write from several.
std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail(const char* what, const std::string& path, int error) {
  throw RunError(std::string("cannot ") + what + " " + path + ": " + reason(error));
}

void write_all_at(int descriptor, std::uint64_t offset, std::string_view bytes,
                  const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write", path, written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

// Some file systems cannot flush (EINVAL, ENOTSUP): that is no failure to store.
void sync_descriptor(int descriptor, const std::string& path) {
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) fail("flush", path, errno);
}

void sync_path(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail("open", path, errno);
  try {
    sync_descriptor(descriptor, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

[[noreturn]] void refuse(const std::string& path, const std::string& message,
                         const std::string& hint = "") {
  Diagnostic diagnostic;
  diagnostic.file = path;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

}  // namespace

AtomicFile::AtomicFile(const std::string& final_path) : path_(final_path), part_(final_path + ".part") {
  // Found out now rather than when all is written: a file cannot take a folder's name.
  if (std::error_code error; std::filesystem::is_directory(final_path, error))
    fail("create", final_path, EISDIR);
  descriptor_ = create_output_file(part_);
  buffer_.reserve(kBufferSize);
}

AtomicFile::~AtomicFile() {
  if (!committed_ && descriptor_ >= 0 && is_file_at(descriptor_, part_)) remove_output_file(part_);
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::write(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  if (buffer_.size() + size > kBufferSize) flush();
  if (size >= kBufferSize) {
    write_all(descriptor_, {bytes, size}, part_);
  } else {
    buffer_.insert(buffer_.end(), bytes, bytes + size);
  }
  size_ += size;
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  write_all_at(descriptor_, offset, bytes, part_);
}

void AtomicFile::flush() {
  write_all(descriptor_, {buffer_.data(), buffer_.size()}, part_);
  buffer_.clear();
}

void AtomicFile::commit() {
  flush();
  sync_descriptor(descriptor_, part_);
  // Network file systems report a full disk only when a file is closed; the file stays locked by the second descriptor.
  const int closed = ::dup(descriptor_);
  if (closed < 0 || ::close(closed) != 0) fail("close", part_, errno);
  if (!is_file_at(descriptor_, part_)) throw RunError("cannot finish " + path_ + ": " + part_ + " was replaced meanwhile");
  if (::rename(part_.c_str(), path_.c_str()) != 0) fail("give its final name to", part_, errno);
  committed_ = true;
  sync_path(folder_of(path_), O_RDONLY | O_DIRECTORY);
}

void write_part_file(const std::string& path, std::string_view bytes) {
  const int descriptor = create_output_file(path);
  try {
    write_all(descriptor, bytes, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0) fail("close", path, errno);
}

// One flush of the whole file system: one for each of thousands of files would take minutes.
void commit_folder(const std::string& part, const std::string& path) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail("open", part, errno);
  const int error = ::syncfs(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error) fail("flush", part, error);
  if (::rename(part.c_str(), path.c_str()) != 0) fail("give its final name to", part, errno);
  sync_path(folder_of(path), O_RDONLY | O_DIRECTORY);
}

void write_text_file(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

std::string read_whole_file(const std::string& path) { return read_file(path); }

void prepare_output_folder(const std::string& folder, bool force,
                           const std::vector<std::string>& outputs) {
  make_output_folder(folder);
  std::error_code error;
  const bool empty = std::filesystem::is_empty(folder, error);
  if (error) throw RunError("cannot read the folder " + folder + ": " + error.message());
  if (empty) return;
  if (!force) {
    refuse(folder, "the output folder is not empty",
           "--force replaces the files of the earlier run and leaves all others");
  }
  remove_plain_files(folder, outputs);
  remove_plain_files(folder, outputs, ".part");
}

void refuse_to_replace(const std::string& folder, const std::vector<std::string>& names, bool force) {
  for (const std::string& name : names) {
    std::error_code failed;
    const std::string path = folder + "/" + name;
    if (!force && std::filesystem::exists(std::filesystem::symlink_status(path, failed)))
      refuse(path, "is there already", "--force replaces it");
  }
}

std::string output_folder_of(const std::string& asked, const std::string& dataset, const std::string& name) {
  return asked.empty() ? make_folder_below(dataset, name) : asked;
}

}  // namespace rubble
