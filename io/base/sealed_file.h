// The envelope of our own binary files: what they are, which version, how long, and a checksum.
//
// Little-endian, no padding:
//   8 bytes   the kind of file
//   u32       version of the content's format
//   u64       size of the content, in bytes
//   content
//   32 bytes  SHA-256 of all that precedes it
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/base/little_endian.h"
#include "kernel/base/math.h"

namespace rubble {

struct SealedKind {
  std::string_view magic;             // 8 bytes
  std::uint32_t version = 1;          // of the format, as it is written
  std::string_view name;              // in messages, e.g. "pile state"
  std::string_view where;             // for someone who gave another file: where one is found
  std::string_view if_other_version;  // what to do about a file of another version
  std::uint32_t oldest = 0;           // version that is read as well; 0: `version` alone
};

// Throws RunError when the file cannot be written.
void save_sealed(const SealedKind& kind, std::string_view content, const std::string& path);

// The content. Throws InputError for a missing, foreign, truncated or altered file, or another
// version.
std::string load_sealed(const SealedKind& kind, const std::string& path);

// Reads numbers off a content; every step throws InputError, naming the file, rather than reading
// past the end.
class SealedReader {
 public:
  // All three must outlive the reader.
  SealedReader(const SealedKind& kind, std::string_view content, const std::string& path)
      : kind_(kind), bytes_(content), path_(path) {}

  [[noreturn]] void fail(const std::string& message, std::string_view hint = {}) const;

  template <typename T>
  T number() {
    T value{};
    if (!take(bytes_, value)) fail_short();
    return value;
  }
  Vec3 vector();
  std::string text();  // u32 length, then the bytes
  std::string_view bytes(std::uint64_t size);
  std::size_t left() const { return bytes_.size(); }

 private:
  [[noreturn]] void fail_short() const;

  const SealedKind& kind_;
  std::string_view bytes_;
  const std::string& path_;
};

}  // namespace rubble
