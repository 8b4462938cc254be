#include "io/state/checkpoint_file.h"
#include "kernel/world/world_snapshot.h"
#include "tests/fuzz/fuzz_file.h"
#include "tests/fuzz/sealed_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path =
      fuzz::folder().write("settle.checkpoint", fuzz::seal("RUBCHKP\n", kCheckpointVersion, bytes));
  fuzz::knock([&] { decode_snapshot(load_checkpoint(path).world); });
}
