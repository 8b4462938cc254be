#include "io/base/remove_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "kernel/base/error.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int number() const { return number_; }
  bool good() const { return number_ >= 0; }

 private:
  int number_;
};

// The parts of a name; none: it is no name of a file below a folder.
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '\0') return {};
    if (c == '/')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (const std::string& part : parts)
    if (part.empty() || part == "." || part == "..") return {};
  return parts;
}

// The folder that holds the last of `count` parts; not good: a part is missing or is a link.
Descriptor open_parent(const std::string& folder, const std::vector<std::string>& parts,
                       std::size_t count) {
  Descriptor at(open(folder.c_str(), kFolder));
  for (std::size_t i = 0; i + 1 < count && at.good(); ++i)
    at = Descriptor(openat(at.number(), parts[i].c_str(), kFolder | O_NOFOLLOW));
  return at;
}

void remove_plain_file(const std::string& folder, const std::string& name) {
  const std::vector<std::string> parts = parts_of(name);
  if (parts.empty()) return;
  const Descriptor parent = open_parent(folder, parts, parts.size());
  struct stat status {};
  if (!parent.good() ||
      fstatat(parent.number(), parts.back().c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 ||
      !S_ISREG(status.st_mode))
    return;
  if (unlinkat(parent.number(), parts.back().c_str(), 0) == 0 || errno == ENOENT) return;
  throw RunError("cannot remove " + folder + "/" + name + ": " +
                 std::generic_category().message(errno));
}

}  // namespace

void remove_plain_files(const std::string& folder, const std::vector<std::string>& names,
                        const std::string& suffix) {
  for (const std::string& name : names) remove_plain_file(folder, name + suffix);
}

void remove_empty_parents(const std::string& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::vector<std::string> parts = parts_of(name);
    for (std::size_t count = parts.empty() ? 0 : parts.size() - 1; count > 0; --count) {
      const Descriptor parent = open_parent(folder, parts, count);
      if (!parent.good() || unlinkat(parent.number(), parts[count - 1].c_str(), AT_REMOVEDIR) != 0)
        break;  // not empty, or not there
    }
  }
}

std::vector<std::string> list_plain_files(const std::string& folder, const std::string& name) {
  std::vector<std::string> files;
  std::error_code failed;
  const fs::path root = fs::path(folder) / name;
  if (!fs::is_directory(fs::symlink_status(root, failed))) return files;
  for (fs::recursive_directory_iterator at(root, failed), end; !failed && at != end;
       at.increment(failed))
    if (fs::is_regular_file(at->symlink_status(failed)))
      files.push_back((fs::path(name) / at->path().lexically_relative(root)).string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace rubble
