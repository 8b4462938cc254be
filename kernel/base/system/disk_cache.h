// Results that are dear to make, kept on disk between runs under the hash of everything they follow
// from. Deleting the folder, or any part of it, changes nothing but the time that a run takes.
//
// One file an entry, with its kind, key, size and checksum; written under a temporary name, then
// renamed, so that any number of processes may share a folder. A file that is damaged in any way
// counts as absent and is removed. When the folder outgrows its bound, the entries that were not
// used for the longest time go first. Files of others in it, or below it, are neither counted nor removed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernel/base/hash.h"

namespace rubble {

class CacheWriter;

class DiskCache {
 public:
  static constexpr std::uint64_t kUsualLimit = std::uint64_t(4) << 30;  // unit: byte

  // An empty folder makes a cache that never holds anything.
  explicit DiskCache(std::string folder = {}, std::uint64_t limit_bytes = kUsualLimit);

  // $RUBBLE_CACHE (set but empty, or "off": none), else $XDG_CACHE_HOME/rubble, else
  // ~/.cache/rubble; "" where none of these is known.
  static std::string usual_folder();

  const std::string& folder() const { return folder_; }
  // kind: what it is, in lower-case letters, digits and '_'; key: see CacheKey. Nothing when there
  // is no whole entry.
  std::optional<std::string> find(std::string_view kind, const std::string& key) const;
  // False when it could not be kept: the run goes on without.
  bool store(std::string_view kind, const std::string& key, std::string_view bytes) const;
  // What write(writer) puts goes to the file at once: for entries that are large.
  bool store(std::string_view kind, const std::string& key, const std::function<void(CacheWriter&)>& write) const;

 private:
  void trim() const;

  std::string folder_;
  std::uint64_t limit_;
};

// The hash of everything that a result follows from: begin with a name and a version of the code
// that makes it, and raise the version whenever that code changes.
class CacheKey {
 public:
  CacheKey(std::string_view maker, int version);
  template <typename T>
  CacheKey& add(const T& number) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "padding must not be hashed");
    hash_.add(&number, sizeof number);
    return *this;
  }
  CacheKey& add_text(std::string_view text);  // its length too
  CacheKey& add_bytes(const void* data, std::size_t size);
  std::string hex() { return hash_.hex(); }  // ends the key

 private:
  Sha256 hash_;
};

// Entries are made of numbers and arrays of them, as this machine holds them: a cache is never
// carried from one machine to another, and a version in the key tells layouts apart.
class CacheWriter {
 public:
  using Sink = std::function<void(std::string_view bytes)>;

  CacheWriter() = default;  // keeps all bytes
  explicit CacheWriter(Sink sink) : sink_(std::move(sink)) {}  // hands them on, in order

  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes({reinterpret_cast<const char*>(&value), sizeof value});
  }
  template <typename T>
  void put(const std::vector<T>& values) {
    put(std::uint64_t(values.size()));
    put_values(values.data(), values.size());
  }
  // Without their number: for an array in parts.
  template <typename T>
  void put_values(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes({reinterpret_cast<const char*>(values), count * sizeof(T)});
  }
  void put_bytes(std::string_view bytes) {
    if (sink_)
      sink_(bytes);
    else
      bytes_.append(bytes);
  }
  const std::string& bytes() const { return bytes_; }  // empty with a sink

 private:
  Sink sink_;
  std::string bytes_;
};

// Reads in the order of writing. A read past the end gives nothing and makes whole() false.
class CacheReader {
 public:
  explicit CacheReader(std::string_view bytes) : rest_(bytes) {}
  template <typename T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (take(sizeof value)) std::memcpy(static_cast<void*>(&value), taken_, sizeof value);
  }
  template <typename T>
  void get(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = 0;
    get(count);
    if (count > rest_.size() / sizeof(T)) good_ = false;
    if (!good_) return;
    values.resize(std::size_t(count));
    if (count && take(values.size() * sizeof(T)))
      std::memcpy(static_cast<void*>(values.data()), taken_, values.size() * sizeof(T));
  }
  // Everything was there, and nothing is left.
  bool whole() const { return good_ && rest_.empty(); }

 private:
  bool take(std::size_t size) {
    good_ = good_ && size <= rest_.size();
    if (!good_) return false;
    taken_ = rest_.data();
    rest_.remove_prefix(size);
    return true;
  }

  std::string_view rest_;
  const char* taken_ = nullptr;
  bool good_ = true;
};

}  // namespace rubble
