// One file out of a ZIP archive, as packages of 3MF are.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

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
