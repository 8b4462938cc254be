#include "io/import/uri.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

namespace rubble {
namespace {

namespace fs = std::filesystem;

int hex_digit(std::string_view text, std::size_t at) {
  if (at >= text.size()) return -1;
  const char c = text[at];
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

std::optional<std::string> decode_base64(std::string_view text) {
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    if (c == '\n' || c == '\r' || c == ' ' || c == '\t') continue;
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | std::uint32_t(digit);
    count += 6;
    if (count >= 8) count -= 8, out += char(bits >> count & 255);
  }
  return out;
}

}  // namespace

std::string decode_percent(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = hex_digit(text, i + 1), low = hex_digit(text, i + 2);
    if (text[i] == '%' && high >= 0 && low >= 0)
      out += char(high * 16 + low), i += 2;
    else
      out += text[i];
  }
  return out;
}

std::optional<std::string> decode_data_uri(std::string_view uri) {
  if (uri.substr(0, 5) != "data:") return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view kind = uri.substr(0, comma), content = uri.substr(comma + 1);
  const bool base64 = kind.size() >= 7 && kind.substr(kind.size() - 7) == ";base64";
  return base64 ? decode_base64(decode_percent(content)) : decode_percent(content);
}

std::optional<std::string> find_beside(const std::string& folder, const std::string& name, const char* subfolder) {
  std::error_code failed;
  for (std::string tried : {name, decode_percent(name)}) {
    std::replace(tried.begin(), tried.end(), '\\', '/');
    if (tried.empty() || tried.find('\0') != std::string::npos) continue;
    const std::string file = fs::path(tried).filename().string();
    const fs::path in(folder);
    for (const fs::path& path : {in / tried, in / file, subfolder ? in / subfolder / file : in / file})
      if (fs::is_regular_file(path, failed)) return path.string();
  }
  return std::nullopt;
}

}  // namespace rubble
