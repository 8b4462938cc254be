// Two hashes: a fast 64-bit hash for states and streams, and SHA-256 for files and content, as
// `sha256sum` computes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace rubble {

// Incremental XXH64 over exactly the bytes that are added. Numbers are added as their
// little-endian bit patterns, so -0.0 and 0.0 differ, and so does every last bit.
class StateHash {
 public:
  StateHash();
  ~StateHash();
  StateHash(const StateHash&) = delete;
  StateHash& operator=(const StateHash&) = delete;

  void add_bytes(const void* data, std::size_t size);
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T>, "add the members one by one: padding is not hashed");
    add_bytes(&value, sizeof value);
  }
  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::uint64_t hash64(std::string_view bytes);
// 16 lower-case hexadecimal digits, most significant first.
std::string hex64(std::uint64_t value);

// Incremental SHA-256.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const void* data, std::size_t size);
  std::string hex();  // 64 digits; ends the hash

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256(std::string_view bytes);
// Throws RunError when the file cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace rubble
