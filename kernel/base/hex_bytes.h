// Bytes as text.
#pragma once

#include <cstddef>
#include <string>

namespace rubble {

// Two lower-case hexadecimal digits a byte.
inline std::string hex_of_bytes(const unsigned char* bytes, std::size_t size) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
  }
  return text;
}

}  // namespace rubble
