// One gzip member: compressed bytes that can be appended to others in one .gz file, which every
// reader takes for one stream. It holds no name and no time.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/base/file_cursor.h"

namespace rubble {

// level: 0 (stored) to 9. Throws RunError when zlib fails.
std::string make_gzip_member(std::string_view bytes, int level);

// Decompresses a whole .gz file and compares the checksum and the size at the end of each member.
// Nothing: it is sound. Throws InputError when it cannot be read.
std::optional<FileFault> check_gzip(const std::string& path);

}  // namespace rubble
