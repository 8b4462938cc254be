// Numbers and texts as ROS puts them on the wire, for both versions of ROS.
//
// ROS 1 packs fields one after another. ROS 2 uses CDR (OMG's Common Data Representation, version
// 1): a header of 4 bytes that says "little-endian", every number aligned to its own size counted
// from the end of that header, and texts that end in a NUL which their length includes. A message
// has the same fields in the same order in both, but for the sequence number in a ROS 1 header.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble::ros {

enum class Version { ros1, ros2 };

class Wire {
 public:
  // `capacity`: bytes that the message will need, about.
  explicit Wire(Version version, std::size_t capacity = 256) : version_(version) {
    bytes_.reserve(capacity);
    if (version == Version::ros2) bytes_.assign("\x00\x01\x00\x00", kEncapsulation);
  }

  Version version() const { return version_; }

  template <typename T>
  void number(T value) {
    align(sizeof value);
    put(bytes_, value);
  }
  void boolean(bool value) { number(std::uint8_t{value}); }
  void count(std::size_t elements) { number(static_cast<std::uint32_t>(elements)); }
  void text(std::string_view value) {
    const bool nul = version_ == Version::ros2;
    count(value.size() + nul);
    bytes_.append(value);
    if (nul) bytes_ += '\0';
  }
  // uint8[]: its size, then the bytes.
  void blob(std::string_view value) {
    count(value.size());
    bytes_.append(value);
  }
  // Seconds have 32 bits: with a sign in ROS 2, until 19 January 2038; without in ROS 1, until 2106. Throws RunError
  // for a stamp that does not fit.
  void time(std::int64_t stamp_ns) {
    const std::int64_t limit = std::int64_t{1} << (version_ == Version::ros2 ? 31 : 32);
    if (stamp_ns < 0 || stamp_ns / 1000000000 >= limit)
      throw RunError("a message of ROS " + std::string(version_ == Version::ros2 ? "2" : "1") +
                     " cannot hold the stamp " + std::to_string(stamp_ns) + " ns: its seconds end at " +
                     std::to_string(limit - 1) + "; begin earlier (start_ns)");
    number(static_cast<std::uint32_t>(stamp_ns / 1000000000));
    number(static_cast<std::uint32_t>(stamp_ns % 1000000000));
  }

  std::string take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kEncapsulation = 4;  // unit: byte

  void align(std::size_t size) {
    if (version_ == Version::ros1) return;
    const std::size_t over = (bytes_.size() - kEncapsulation) % size;
    if (over) bytes_.append(size - over, '\0');
  }

  Version version_;
  std::string bytes_;
};

}  // namespace rubble::ros
