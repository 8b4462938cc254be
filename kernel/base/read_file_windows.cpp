// In the place of read_file.cpp on Windows, which has no pipes by name: regular files alone.
#include <filesystem>
#include <fstream>

#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {

std::string read_file(const std::string& path, std::uint64_t limit) {
  const auto refuse = [&](const std::string& message, const std::string& expected = "") {
    throw InputError({path, 0, "", message, expected, "", ""});
  };
  check_may_read(path);
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) refuse("is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse("cannot be opened");
  std::string content;
  char block[1 << 16];
  while (file.read(block, sizeof block), file.gcount() > 0) {
    content.append(block, std::size_t(file.gcount()));
    if (content.size() > limit) refuse("is too large", "at most " + std::to_string(limit >> 20) + " MiB");
  }
  if (file.bad()) refuse("cannot be read");
  return content;
}

void check_readable_file(const std::string& path) {
  check_may_read(path);
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(path, failed);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError({path, 0, "", "cannot be read", "a file", "a pipe, folder or device", ""});
}

}  // namespace rubble
