// What a decompressor writes into: it grows with what is there, up to the size that a file states.
// That size is believed for nothing else, as a file of 100 bytes may state gigabytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace rubble {

class UnpackedBytes {
 public:
  explicit UnpackedBytes(std::uint64_t stated) : stated_(stated) {}

  // Room for more; 0 when all that was stated is there.
  std::size_t room() {
    if (size_ == bytes_.size())
      bytes_.resize(std::min<std::uint64_t>(stated_, std::max(2 * size_, kFirst)));
    return bytes_.size() - size_;
  }
  char* end() { return bytes_.data() + size_; }
  void add(std::size_t count) { size_ += count; }

  bool whole() const { return size_ == stated_; }
  std::string take() { return std::move(bytes_); }  // where it is whole

 private:
  static constexpr std::size_t kFirst = 1 << 20;  // unit: byte

  std::uint64_t stated_;
  std::string bytes_;
  std::size_t size_ = 0;  // of what is written
};

}  // namespace rubble
