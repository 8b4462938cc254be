// A file read once from its begin to its end, in records, that knows where it is: for readers that
// must say at which byte a file stops being what it should be.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace rubble {

// The first place where a file is not what its format says.
struct FileFault {
  std::uint64_t byte = 0;  // from the file's begin
  std::string what;        // "the file ends within a chunk"
};

// Thrown within a reader, and returned by it.
struct FaultFound {
  FileFault fault;  // where and what
};

class FileCursor {
 public:
  explicit FileCursor(const std::string& path);  // throws InputError when it cannot be read

  std::uint64_t at() const { return at_; }      // of the next byte
  std::uint64_t size() const { return size_; }  // of the file
  std::uint64_t left() const { return size_ - at_; }

  // The next bytes. Throws FaultFound, at the file's end, when there are fewer: "the file ends
  // within `what`".
  std::string take(std::uint64_t count, const char* what);
  template <typename T>
  T number(const char* what);

 private:
  std::ifstream in_;
  std::uint64_t at_ = 0, size_ = 0;
};

// What a damaged length must not make a reader allocate; unit: byte.
inline constexpr std::uint64_t kLargestRecord = std::uint64_t{1} << 32;

[[noreturn]] inline void fail_at(std::uint64_t byte, std::string what) {
  throw FaultFound{{byte, std::move(what)}};
}

template <typename T>
T FileCursor::number(const char* what) {
  const std::string bytes = take(sizeof(T), what);
  T value;
  bytes.copy(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

}  // namespace rubble
