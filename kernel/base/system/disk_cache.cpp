#include "kernel/base/system/disk_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace rubble {

namespace fs = std::filesystem;

namespace {

constexpr char kMagic[8] = {'R', 'B', 'L', 'C', 'A', 'C', 'H', '1'};
constexpr double kTrimmedTo = 0.8;  // of the bound, so that not every entry has to trim

struct Header {
  char magic[8];
  std::uint64_t name_hash;  // of kind and key: a renamed file is no entry
  std::uint64_t size;
  std::uint64_t checksum;
};

Header make_header(std::string_view kind, const std::string& key, std::string_view bytes) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.name_hash = hash64(std::string(kind) + "/" + key);
  header.size = bytes.size();
  header.checksum = hash64(bytes);
  return header;
}

std::string entry_path(const std::string& folder, std::string_view kind, const std::string& key) {
  return folder + "/" + std::string(kind) + "/" + key + ".cache";
}

// All of a file, or nothing: the reason does not matter to a cache.
std::optional<std::string> read_all(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return std::nullopt;
  std::string bytes;
  struct stat status{};
  if (fstat(fileno(file), &status) == 0 && S_ISREG(status.st_mode))
    bytes.resize(std::size_t(status.st_size));
  const bool good = std::fread(bytes.data(), 1, bytes.size(), file) == bytes.size();
  std::fclose(file);
  if (!good) return std::nullopt;
  return bytes;
}

bool write_all(const std::string& path, const Header& header, std::string_view bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return false;
  bool good = std::fwrite(&header, sizeof header, 1, file) == 1;
  good = good && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  return std::fclose(file) == 0 && good;
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
    const Header wanted = make_header(kind, key, *bytes);
    if (std::memcmp(&found, &wanted, sizeof found) == 0) {
      utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // used just now
      return bytes;
    }
  }
  std::error_code ignored;
  fs::remove(path, ignored);
  return std::nullopt;
}

bool DiskCache::store(std::string_view kind, const std::string& key, std::string_view bytes) const {
  if (folder_.empty() || bytes.size() > limit_) return false;
  const std::string path = entry_path(folder_, kind, key);
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) return false;
  const std::string part = temporary_name(path);
  bool kept = write_all(part, make_header(kind, key, bytes), bytes);
  if (kept) {
    fs::rename(part, path, error);
    kept = !error;
  }
  if (!kept) fs::remove(part, error);
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
  for (fs::recursive_directory_iterator it(folder_, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code gone;  // another process may remove it meanwhile
    if (!it->is_regular_file(gone)) continue;
    const Entry entry{it->last_write_time(gone), it->file_size(gone), it->path()};
    if (gone || (entry.path.extension() != ".cache" && entry.path.extension() != ".part")) continue;
    total += entry.size;
    entries.push_back(entry);
  }
  if (total <= limit_) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.used != b.used ? a.used < b.used : a.path < b.path;
  });
  for (const Entry& entry : entries) {
    if (double(total) <= kTrimmedTo * double(limit_)) break;
    std::error_code ignored;
    fs::remove(entry.path, ignored);
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
