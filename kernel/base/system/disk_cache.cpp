#include "kernel/base/system/disk_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {

namespace fs = std::filesystem;

namespace {

constexpr char kMagic[8] = {'R', 'B', 'L', 'C', 'A', 'C', 'H', '1'};
constexpr std::size_t kBlock = 1 << 16;  // unit: byte
constexpr double kTrimmedTo = 0.8;  // of the bound, so that not every entry has to trim

struct Header {
  char magic[8];
  std::uint64_t name_hash;  // of kind and key: a renamed file is no entry
  std::uint64_t size;
  std::uint64_t checksum;
};

Header make_header(std::string_view kind, const std::string& key, std::uint64_t size, std::uint64_t checksum) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.name_hash = hash64(std::string(kind) + "/" + key);
  header.size = size;
  header.checksum = checksum;
  return header;
}

std::string entry_path(const std::string& folder, std::string_view kind, const std::string& key) {
  return folder + "/" + std::string(kind) + "/" + key + ".cache";
}

// All of a file, or nothing: the reason does not matter to a cache.
std::optional<std::string> read_all(const std::string& path) {
  try {
    return read_file(path);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

// A file that is closed in any case. Throws RunError where it cannot be written.
class EntryFile {
 public:
  explicit EntryFile(const std::string& path) : path_(path), file_(create_output_file(path)) {}
  ~EntryFile() {
    if (file_ >= 0) ::close(file_);
  }
  EntryFile(const EntryFile&) = delete;
  EntryFile& operator=(const EntryFile&) = delete;

  void write(std::string_view bytes) { write_all(file_, bytes, path_); }
  // Begins again at the first byte.
  void rewind() {
    if (lseek(file_, 0, SEEK_SET) != 0) throw RunError(path_ + ": cannot be written again from its beginning");
  }
  bool close() { return ::close(std::exchange(file_, -1)) == 0; }

 private:
  const std::string path_;
  int file_;
};

// A place for the header, by whose first bytes trim() knows the file; what write() puts; then the header, which has the
// checksum of these bytes. limit: of their number.
bool write_entry(const std::string& path, std::string_view kind, const std::string& key, std::uint64_t limit,
                 const std::function<void(CacheWriter&)>& write) {
  try {
    EntryFile file(path);
    const auto put_header = [&file](const Header& header) { file.write({reinterpret_cast<const char*>(&header), sizeof header}); };
    put_header(make_header(kind, key, 0, 0));
    StateHash checksum;
    std::uint64_t size = 0;
    std::string waiting;  // small values together
    const auto flush = [&] {
      checksum.add_bytes(waiting.data(), waiting.size());
      file.write(waiting);
      waiting.clear();
    };
    CacheWriter writer([&](std::string_view bytes) {
      size += bytes.size();
      if (size > limit) throw RunError(path + ": larger than the cache may be");
      if (waiting.size() + bytes.size() > kBlock) flush();
      if (bytes.size() <= kBlock) {
        waiting.append(bytes);
      } else {
        checksum.add_bytes(bytes.data(), bytes.size());
        file.write(bytes);
      }
    });
    write(writer);
    flush();
    file.rewind();
    put_header(make_header(kind, key, size, checksum.digest()));
    return file.close();
  } catch (const std::runtime_error&) {
    return false;
  }
}

// A folder may be used for other things, too: only what this cache wrote counts, by place, name and first bytes. A
// file that was begun and has no bytes yet counts by its name: KEY.cache.PROCESS.NUMBER.part.
bool has_name_of_entry(const fs::path& path) {
  std::string name = path.filename().string();
  const auto drop_end = [&name](const char* end) {
    const std::size_t at = name.rfind(end);
    const bool there = at != std::string::npos && at > 0 && at + std::string_view(end).size() == name.size();
    if (there) name.resize(at);
    return there;
  };
  const auto drop_number = [&name] {
    const std::size_t dot = name.rfind('.');
    const bool there = dot != std::string::npos && dot + 1 < name.size() &&
                       name.find_first_not_of("0123456789", dot + 1) == std::string::npos;
    if (there) name.resize(dot);
    return there;
  };
  if (drop_end(".part") && !(drop_number() && drop_number())) return false;
  return drop_end(".cache") && name.size() == 64 &&
         name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

bool has_bytes_of_entry(const fs::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return false;
  char magic[sizeof kMagic];
  const std::size_t count = std::fread(magic, 1, sizeof magic, file);
  std::fclose(file);
  return std::memcmp(magic, kMagic, count) == 0 && (count == sizeof magic || path.extension() == ".part");
}

std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  return path + "." + std::to_string(getpid()) + "." + std::to_string(count++) + ".part";
}

}  // namespace

DiskCache::DiskCache(std::string folder, std::uint64_t limit_bytes)
    : folder_(std::move(folder)), limit_(limit_bytes) {}

std::string DiskCache::usual_folder() {
  if (const char* own = std::getenv("RUBBLE_CACHE"))
    return std::string_view(own) == "off" ? "" : own;
  const char* shared = std::getenv("XDG_CACHE_HOME");
  // The XDG rules say that a relative path there is to be ignored.
  if (shared && shared[0] == '/') return std::string(shared) + "/rubble";
  const char* home = std::getenv("HOME");
  return home && home[0] == '/' ? std::string(home) + "/.cache/rubble" : "";
}

std::optional<std::string> DiskCache::find(std::string_view kind, const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  const std::string path = entry_path(folder_, kind, key);
  std::optional<std::string> bytes = read_all(path);
  if (!bytes) return std::nullopt;
  Header found{};
  if (bytes->size() >= sizeof found) {
    std::memcpy(&found, bytes->data(), sizeof found);
    bytes->erase(0, sizeof found);
    const Header wanted = make_header(kind, key, bytes->size(), hash64(*bytes));
    if (std::memcmp(&found, &wanted, sizeof found) == 0) {
      utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // used just now
      return bytes;
    }
  }
  remove_output_file(path);
  return std::nullopt;
}

bool DiskCache::store(std::string_view kind, const std::string& key, std::string_view bytes) const {
  return bytes.size() <= limit_ && store(kind, key, [bytes](CacheWriter& writer) { writer.put_bytes(bytes); });
}

bool DiskCache::store(std::string_view kind, const std::string& key, const std::function<void(CacheWriter&)>& write) const {
  if (folder_.empty()) return false;
  const std::string path = entry_path(folder_, kind, key);
  std::error_code error;
  try {
    make_output_folder(folder_);
    make_folder_below(folder_, std::string(kind));
  } catch (const std::runtime_error&) {
    return false;
  }
  const std::string part = temporary_name(path);
  bool kept = write_entry(part, kind, key, limit_, write);
  if (kept) {
    fs::rename(part, path, error);
    kept = !error;
  }
  if (!kept) remove_output_file(part);
  if (kept) trim();
  return kept;
}

void DiskCache::trim() const {
  struct Entry {
    fs::file_time_type used;
    std::uint64_t size;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code error;
  for (const auto& kind : fs::directory_iterator(folder_, error)) {
    std::error_code gone;  // another process may remove it meanwhile
    if (!fs::is_directory(kind.symlink_status(gone))) continue;
    for (const auto& file : fs::directory_iterator(kind.path(), gone)) {
      std::error_code lost;
      if (!has_name_of_entry(file.path()) || !fs::is_regular_file(file.symlink_status(lost))) continue;
      const Entry entry{file.last_write_time(lost), file.file_size(lost), file.path()};
      if (lost) continue;
      total += entry.size;
      entries.push_back(entry);
    }
  }
  if (total <= limit_) return;
  const auto is_foreign = [&total](const Entry& entry) {
    const bool foreign = !has_bytes_of_entry(entry.path);
    if (foreign) total -= entry.size;
    return foreign;
  };
  entries.erase(std::remove_if(entries.begin(), entries.end(), is_foreign), entries.end());
  if (total <= limit_) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.used != b.used ? a.used < b.used : a.path < b.path;
  });
  for (const Entry& entry : entries) {
    if (double(total) <= kTrimmedTo * double(limit_)) break;
    remove_output_file(entry.path.string());
    total -= entry.size;
  }
}

CacheKey::CacheKey(std::string_view maker, int version) { add_text(maker).add(version); }

CacheKey& CacheKey::add_text(std::string_view text) {
  add(std::uint64_t(text.size()));
  return add_bytes(text.data(), text.size());
}

CacheKey& CacheKey::add_bytes(const void* data, std::size_t size) {
  hash_.add(data, size);
  return *this;
}

}  // namespace rubble
