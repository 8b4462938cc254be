// Compressed files: members of gzip, and files out of ZIP archives.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/base/file_cursor.h"

namespace rubble {

// One gzip member: compressed bytes that can be appended to others in one .gz file, which every
// reader takes for one stream. It holds no name and no time.

// level: 0 (stored) to 9. Throws RunError when zlib fails.
std::string make_gzip_member(std::string_view bytes, int level);

// Decompresses a whole .gz file and compares the checksum and the size at the end of each member.
// Nothing: it is sound. Throws InputError when it cannot be read.
std::optional<FileFault> check_gzip(const std::string& path);

// One file out of a ZIP archive, as packages of 3MF are.
struct ZipEntry {
  std::string name;
  std::uint64_t offset = 0, packed = 0, size = 0;  // unit: byte; offset: of the local header
  int method = 0;                                  // 0: stored, 8: deflated
};

// The list of files at the end of the archive; empty: it is no archive. (ZIP64 only for sizes and places.)
std::vector<ZipEntry> list_zip(std::string_view archive);

// The bytes of an entry. Nothing: it is damaged, encrypted, or larger than the limit.
std::optional<std::string> read_zip_entry(std::string_view archive, const ZipEntry& entry, std::uint64_t limit);

}  // namespace rubble
