#include "kernel/base/text.h"

#include <algorithm>
#include <cstdint>

#include "kernel/base/hash.h"

namespace rubble {
namespace {

constexpr std::size_t kLongestName = 100;  // unit: byte

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? std::uint8_t(text[i]) : std::uint8_t(0);
}

// The bytes of the character that begins at i; 0: none does. Table 3-7 of the Unicode standard.
std::size_t character_size(std::string_view text, std::size_t i) {
  const std::uint8_t first = byte_at(text, i), second = byte_at(text, i + 1);
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  std::uint8_t low = 0x80, high = 0xbf;
  if (first == 0xe0) low = 0xa0;
  if (first == 0xed) high = 0x9f;
  if (first == 0xf0) low = 0x90;
  if (first == 0xf4) high = 0x8f;
  if (second < low || second > high) return 0;
  const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  for (std::size_t k = 2; k < size; ++k)
    if ((byte_at(text, i + k) & 0xc0) != 0x80) return 0;
  return size;
}

bool is_control(std::string_view text, std::size_t i) {
  const std::uint8_t first = byte_at(text, i);
  if (first == '\n' || first == '\t') return false;
  return first < 0x20 || first == 0x7f || (first == 0xc2 && byte_at(text, i + 1) < 0xa0);
}

}  // namespace

std::size_t find_invalid_utf8(std::string_view text) {
  for (std::size_t i = 0, size = 0; i < text.size(); i += size) {
    size = character_size(text, i);
    if (size == 0) return i;
  }
  return std::string_view::npos;
}

int calc_json_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;
    if (c == '"') in_string = !in_string;
    if (in_string) continue;
    if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  return deepest;
}

std::string printable(std::string_view text) {
  static const char* const kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_size(text, i);
    if (size > 0 && !is_control(text, i)) {
      shown += text.substr(i, size);
      i += size;
      continue;
    }
    for (std::size_t end = i + (size > 0 ? size : 1); i < end; ++i) {
      const std::uint8_t byte = byte_at(text, i);
      shown += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return shown;
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : printable(text)) {
    if (c == '\n')
      line += "\\x0a";
    else if (c == '\t')
      line += "\\x09";
    else
      line += c;
  }
  return line;
}

std::string find_name_fault(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestName) return "has more than 100 bytes";
  if (find_invalid_utf8(name) != std::string_view::npos) return "is not UTF-8";
  if (one_line(name) != name) return "has control characters";
  if (name.find_first_of("/\\") != std::string_view::npos) return "has a slash or backslash";
  return name[0] == '.' ? "begins with a dot" : "";
}

std::string file_name_of(std::string_view name) {
  if (find_name_fault(name).empty()) return std::string(name);
  std::string plain;
  for (const char c : name.substr(0, kLongestName / 2)) {
    const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    plain += kept ? c : '_';
  }
  return plain + "_" + hex64(hash64(name));
}

}  // namespace rubble
