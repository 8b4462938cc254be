#include "app/support/print.h"

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <set>

#include "kernel/base/text.h"

namespace rubble {
namespace {

void put(std::FILE* stream, const std::string& text) { std::fwrite(text.data(), 1, text.size(), stream); }

std::string format_text(const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  std::string text(size > 0 ? std::size_t(size) + 1 : 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  text.pop_back();
  return text;
}

// DEL and U+0080 to U+009F, which JSON allows within strings as they are.
std::string escape_json_controls(const std::string& json) {
  std::string text;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto byte = std::uint8_t(json[i]), next = std::uint8_t(i + 1 < json.size() ? json[i + 1] : 0);
    const bool pair = byte == 0xc2 && next >= 0x80 && next < 0xa0;
    if (byte != 0x7f && !pair) {
      text += json[i];
      continue;
    }
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\u%04x", unsigned(pair ? next : byte));
    text += escaped;
    i += pair;
  }
  return text;
}

}  // namespace

void print_out(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  put(stdout, printable(format_text(format, arguments)));
  va_end(arguments);
}

void print_err(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  put(stderr, printable(format_text(format, arguments)));
  va_end(arguments);
}

void print_warnings(const std::vector<std::string>& sentences) {
  static std::mutex mutex;
  static std::set<std::string> printed;
  const std::lock_guard<std::mutex> lock(mutex);
  for (const std::string& sentence : sentences) {
    if (printed.insert(sentence).second) print_err("warning: %s\n", sentence.c_str());
  }
}

void print_json(const std::string& json) { put(stdout, printable(escape_json_controls(json))); }

void print_result(const std::string& text, bool is_json) {
  if (is_json) return print_json(text);
  print_out("%s", text.c_str());
}

void redraw_line(const std::string& text, bool end) {
  put(stderr, "\r\033[K" + printable(text) + (end ? "\n" : ""));
  std::fflush(stderr);
}

}  // namespace rubble
