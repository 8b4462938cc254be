#include "kernel/base/read_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {
namespace {

constexpr std::size_t kBlock = 1 << 18;  // unit: byte
constexpr auto kWriterPatience = std::chrono::seconds(2);  // for somebody to open the other end of a pipe

std::string reason(int error) { return std::generic_category().message(error); }

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {
    check_may_read(path);
    // Without O_NONBLOCK the very opening of a pipe would wait.
    descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) refuse("cannot be opened: " + reason(errno));
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) close_and_refuse("cannot be read: " + reason(errno));
    if (S_ISDIR(status.st_mode)) close_and_refuse("is a folder");
    pipe_ = S_ISFIFO(status.st_mode);
    size_ = std::size_t(status.st_size);
    if (!S_ISREG(status.st_mode) && !pipe_)
      close_and_refuse("is a device, which may never end", "a file");
  }
  ~Reader() { close(descriptor_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::string read_all(std::uint64_t limit) {
    std::string content;
    // One byte more than the file has: a file that grew meanwhile is noticed.
    std::vector<char> block(pipe_ ? kBlock : std::clamp<std::size_t>(size_ + 1, 4096, kBlock));
    for (std::size_t count = 0; (count = read_block(block)) != 0;) {
      content.append(block.data(), count);
      if (content.size() > limit)
        refuse("is too large", "at most " + std::to_string(limit >> 20) + " MiB");
    }
    return content;
  }

 private:
  [[noreturn]] void refuse(const std::string& message, const std::string& expected = "") const {
    throw InputError({path_, 0, "", message, expected, "", ""});
  }
  // In the constructor, whose destructor will not run.
  [[noreturn]] void close_and_refuse(const std::string& message,
                                     const std::string& expected = "") const {
    close(descriptor_);
    refuse(message, expected);
  }

  // 0: the end.
  std::size_t read_block(std::vector<char>& block) {
    const auto end = std::chrono::steady_clock::now() + kWriterPatience;
    for (;;) {
      const ssize_t count = read(descriptor_, block.data(), block.size());
      if (count > 0) met_ = true;
      if (count > 0 || (count == 0 && (!pipe_ || met_))) return std::size_t(count);
      if (count < 0 && errno == EAGAIN) {
        met_ = true;  // somebody will write
        pollfd ready{descriptor_, POLLIN, 0};
        poll(&ready, 1, -1);
      } else if (count < 0 && errno != EINTR) {
        refuse("cannot be read: " + reason(errno));
      } else if (count == 0) {
        if (std::chrono::steady_clock::now() > end) refuse("is a pipe that nobody writes to");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
  }

  const std::string& path_;
  int descriptor_ = -1;
  std::size_t size_ = 0;  // when it was opened; 0 of a pipe
  bool pipe_ = false, met_ = false;  // met: the other end of the pipe was open
};

}  // namespace

std::string read_file(const std::string& path, std::uint64_t limit) {
  return Reader(path).read_all(limit);
}

void check_readable_file(const std::string& path) {
  check_may_read(path);
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(path, failed);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError({path, 0, "", "cannot be read", "a file", "a pipe, folder or device", ""});
}

}  // namespace rubble
