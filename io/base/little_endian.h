// Numbers as little-endian bytes, appended to a string and read back from one.
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace rubble {

#if !defined(__BYTE_ORDER__) || __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "numbers are copied as they lie in memory: this needs a little-endian machine"
#endif

template <typename T>
void put(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

// Takes a number off the front; false, leaving all as it was, when too few bytes are left.
template <typename T>
bool take(std::string_view& bytes, T& value) {
  static_assert(std::is_arithmetic_v<T>);
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return true;
}

}  // namespace rubble
