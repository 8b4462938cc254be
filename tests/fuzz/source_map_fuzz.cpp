#include "scripting/sandbox/source_map.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const SourceMap map(bytes, "mission");
  map.line_of("pile.mix[1].weight");
  map.literal_of("seed");
}
