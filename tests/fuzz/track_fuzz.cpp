#include "io/base/little_endian.h"
#include "io/state/track_file.h"
#include "kernel/base/hash.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

// With a right checksum: no fuzzer finds one.
static std::string seal(std::string_view magic, std::uint32_t version, std::string_view content) {
  std::string whole(magic);
  put(whole, version);
  put(whole, std::uint64_t(content.size()));
  whole += content;
  const std::string hex = sha256(whole);
  for (std::size_t i = 0; i < hex.size(); i += 2)
    whole += char(std::stoi(hex.substr(i, 2), nullptr, 16));
  return whole;
}

void fuzz_one(std::string_view bytes) {
  const std::string path =
      fuzz::folder().write("track.bin", seal("RUBTRCK\n", kTrackVersion, bytes));
  fuzz::knock([&] { load_track(path).hash(); });
}
