#include "io/base/file_cursor.h"

#include <filesystem>

#include "kernel/base/error.h"
#include "kernel/base/read_file.h"

namespace rubble {

FileCursor::FileCursor(const std::string& path) {
  std::error_code failed;
  check_readable_file(path);
  in_.open(path, std::ios::binary);
  size_ = std::filesystem::file_size(path, failed);
  if (!in_ || failed)
    throw InputError({path, 0, "", "cannot be read", "a file",
                      failed ? failed.message() : "no permission to open it", ""});
}

std::string FileCursor::take(std::uint64_t count, const char* what) {
  if (count > left())
    fail_at(size_, std::string("the file ends within ") + what + ", " +
                       std::to_string(count - left()) + " bytes too early");
  std::string bytes(count, '\0');
  in_.read(bytes.data(), std::streamsize(count));
  if (!in_) fail_at(at_, std::string("the disk gives no bytes of ") + what);
  at_ += count;
  return bytes;
}

}  // namespace rubble
