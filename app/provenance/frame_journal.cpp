#include "app/provenance/frame_journal.h"

#include <filesystem>

#include "app/provenance/frame_hashes.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"

namespace rubble {

FrameJournal::FrameJournal(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::exists(path, failed)) {
    const std::string text = read_whole_file(path);
    std::size_t end = 0;
    for (std::size_t begin = 0; (end = text.find('\n', begin)) != std::string::npos;
         begin = end + 1)
      lines_.push_back(text.substr(begin, end - begin));
    std::filesystem::resize_file(path, text.rfind('\n') + 1, failed);
  }
  out_.open(path, std::ios::app | std::ios::binary);
}

void FrameJournal::note(std::size_t index, const std::vector<std::uint64_t>& hashes) {
  const std::string line = format_hashes(hashes);
  if (index >= lines_.size()) {
    out_ << line << '\n' << std::flush;
    return;
  }
  if (lines_[index] == line) return;
  throw RunError("frame " + std::to_string(index) +
                 " is not the one that was rendered before the run was interrupted: has the "
                 "graphics driver changed? Begin anew with --force");
}

}  // namespace rubble
