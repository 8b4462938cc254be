// Tar archives in memory (POSIX ustar), without anything of the machine or the clock in them.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "kernel/base/error.h"

namespace rubble {

inline constexpr std::size_t kTarBlock = 512;  // unit: byte

// Appends a file. name: up to 100 bytes. Throws RunError: it is longer, or the content is 8 GiB or more.
inline void add_to_tar(std::string& archive, const std::string& name, std::string_view content) {
  if (name.size() > 100 || content.size() >> 33) throw RunError(name + ": a tar archive cannot hold it");
  std::string head(kTarBlock, '\0');
  const auto put_text = [&](std::size_t at, std::string_view text) { head.replace(at, text.size(), text); };
  char size[12];
  std::snprintf(size, sizeof size, "%011llo", static_cast<unsigned long long>(content.size()));
  put_text(0, name);
  put_text(100, "0000644");       // mode
  put_text(108, "0000000");       // user
  put_text(116, "0000000");       // group
  put_text(124, size);
  put_text(136, "00000000000");   // time
  put_text(148, "        ");      // the checksum counts itself as blanks
  put_text(156, "0");             // a plain file
  put_text(257, {"ustar\00000", 8});
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  char checksum[8];
  std::snprintf(checksum, sizeof checksum, "%06o", sum);
  put_text(148, {checksum, 7});
  archive += head;
  archive += content;
  archive.append((kTarBlock - content.size() % kTarBlock) % kTarBlock, '\0');
}

// Two empty blocks.
inline void end_tar(std::string& archive) { archive.append(2 * kTarBlock, '\0'); }

}  // namespace rubble
