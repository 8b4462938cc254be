#include "app/provenance/manifest.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string text(bytes);
  fuzz::knock([&] {
    const Manifest manifest = manifest_from_json(text, "manifest.json");
    find_altered_parts(text, "manifest.json");
    manifest_to_json(manifest);
  });
}
