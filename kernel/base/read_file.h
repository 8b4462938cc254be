// Files that a user names, read whole, without ever waiting for ever.
#pragma once

#include <cstdint>
#include <string>

namespace rubble {

// Regular files, and pipes somebody writes to (`<(command)`, /dev/stdin). Throws InputError naming
// the path: it lies outside the sandbox (kernel/base/system/file_sandbox.h), cannot be opened or read, is a folder or a
// device (/dev/zero has no end), is a pipe that nobody writes to, or holds more than `limit` bytes.
std::string read_file(const std::string& path, std::uint64_t limit = ~std::uint64_t{0});

// For files that are read in parts, or by a library: opening a pipe would wait for its writer. Throws InputError for
// a pipe, folder or device, and for a file outside the sandbox; what is not there is left to whoever opens it.
void check_readable_file(const std::string& path);

}  // namespace rubble
