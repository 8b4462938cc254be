// What every fuzz target shares: bytes become a file in memory, and InputError is how a door refuses.
//
// libFuzzer calls fuzz_one with one input after another. Whatever else than InputError comes out (a
// crash, another exception, an error of a sanitizer, more than 20 s or 2 GiB) is a finding.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "kernel/base/error.h"

namespace rubble::fuzz {

// A folder in memory, of this process; removed when the process ends.
class Folder {
 public:
  Folder() {
    std::string name = "/dev/shm/rubble-fuzz-XXXXXX";
    if (!mkdtemp(name.data())) std::abort();
    path_ = name;
  }
  ~Folder() {
    if (getpid() != owner_) return;  // of a child that an importer ends by exit()
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

  // The path of a file with these bytes.
  std::string write(const std::string& name, std::string_view bytes) const {
    std::string file = path_ + "/" + name;
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0) std::abort();
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::write(descriptor, bytes.data() + at, bytes.size() - at);
      if (count <= 0) std::abort();
      at += std::size_t(count);
    }
    close(descriptor);
    return file;
  }

 private:
  std::string path_;
  pid_t owner_ = getpid();
};

inline const Folder& folder() {
  static const Folder folder;
  return folder;
}

// Runs a door; it may refuse.
template <typename Door>
void knock(Door door) {
  try {
    door();
  } catch (const InputError&) {
  }
}

}  // namespace rubble::fuzz

// Of each target.
void fuzz_one(std::string_view bytes);
