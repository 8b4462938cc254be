// The bytes of a sealed file (io/state): magic, version, length, content, SHA-256 of all of these. For
// targets that look behind the checksum, which no fuzzer finds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/base/little_endian.h"
#include "kernel/base/hash.h"

namespace rubble::fuzz {

inline std::string seal(std::string_view magic, std::uint32_t version, std::string_view content) {
  std::string whole(magic);
  put(whole, version);
  put(whole, std::uint64_t(content.size()));
  whole += content;
  const std::string hex = sha256(whole);
  for (std::size_t i = 0; i < hex.size(); i += 2)
    whole += char(std::stoi(hex.substr(i, 2), nullptr, 16));
  return whole;
}

}  // namespace rubble::fuzz
