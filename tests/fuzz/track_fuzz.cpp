#include "io/state/track_file.h"
#include "tests/fuzz/fuzz_file.h"
#include "tests/fuzz/sealed_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path =
      fuzz::folder().write("track.bin", fuzz::seal("RUBTRCK\n", kTrackVersion, bytes));
  fuzz::knock([&] { load_track(path).hash(); });
}
