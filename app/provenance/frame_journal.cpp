#include "app/provenance/frame_journal.h"

#include "app/provenance/frame_hashes.h"
#include "kernel/base/error.h"

namespace rubble {

FrameJournal::FrameJournal(const std::string& path) : file_(path) {
  const std::string text = file_.read_all();
  std::size_t end = 0;
  for (std::size_t begin = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines_.push_back(text.substr(begin, end - begin));
  const std::size_t whole = text.rfind('\n') + 1;
  if (whole < text.size()) file_.cut(whole);
}

void FrameJournal::note(std::size_t index, const std::vector<std::uint64_t>& hashes) {
  const std::string line = format_hashes(hashes);
  if (index >= lines_.size()) return file_.append(line + "\n");
  if (lines_[index] == line) return;
  throw RunError("frame " + std::to_string(index) +
                 " is not the one that was rendered before the run was interrupted: has the "
                 "graphics driver changed? Start again with --force");
}

}  // namespace rubble
