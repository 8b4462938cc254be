// In the place of atomic_file.cpp on Windows: what the kernel's files need of it, by the standard library. A
// kill leaves no half-written file under its final name; a power cut may.
#include <cstdio>
#include <filesystem>

#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"

namespace rubble {
namespace {

[[noreturn]] void fail(const char* what, const std::string& path, const std::string& reason) {
  throw RunError(std::string("cannot ") + what + " " + path + ": " + reason);
}

}  // namespace

// All is kept until commit(): these files are small.
AtomicFile::AtomicFile(const std::string& final_path) : path_(final_path), part_(final_path + ".part") {
  std::error_code failed;
  if (std::filesystem::is_directory(final_path, failed)) fail("create", final_path, "it is a folder");
}
AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(part_, ignored);
}

void AtomicFile::write(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  buffer_.insert(buffer_.end(), bytes, bytes + size);
  size_ += size;
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) buffer_[std::size_t(offset) + i] = bytes[i];
}

void AtomicFile::commit() {
  std::FILE* file = std::fopen(part_.c_str(), "wb");
  if (!file) fail("create", part_, "it cannot be opened");
  const bool written = std::fwrite(buffer_.data(), 1, buffer_.size(), file) == buffer_.size();
  if (std::fclose(file) != 0 || !written) fail("write", part_, "the disk may be full");
  std::error_code failed;
  std::filesystem::rename(part_, path_, failed);
  if (failed) fail("give its final name to", part_, failed.message());
  committed_ = true;
}

void write_text_file(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

std::string read_whole_file(const std::string& path) { return read_file(path); }

}  // namespace rubble
