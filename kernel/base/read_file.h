// Files that a user names, read whole, without ever waiting for ever.
#pragma once

#include <cstdint>
#include <string>

namespace rubble {

// Regular files, and pipes somebody writes to (`<(command)`, /dev/stdin). Throws InputError naming
// the path: it cannot be opened or read, is a folder or a device (/dev/zero has no end), is a pipe
// that nobody writes to, or holds more than `limit` bytes.
std::string read_file(const std::string& path, std::uint64_t limit = ~std::uint64_t{0});

}  // namespace rubble
