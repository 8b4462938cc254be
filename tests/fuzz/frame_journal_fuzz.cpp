#include "app/provenance/frame_hashes.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("frames.txt", bytes);
  std::vector<std::uint64_t> hashes;
  parse_hashes(std::string(bytes), hashes);
  try {
    FrameJournal journal(path);
    for (std::size_t i = 0; i < 3; ++i) journal.note(i, {1, 2, 3});
  } catch (const RunError&) {  // another frame than was noted
  }
}
