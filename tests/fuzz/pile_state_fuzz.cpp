#include "io/state/pile_state_file.h"
#include "tests/fuzz/fuzz_file.h"
#include "tests/fuzz/sealed_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path =
      fuzz::folder().write("pile.bin", fuzz::seal("RUBPILE\n", kPileStateVersion, bytes));
  fuzz::knock([&] { load_pile_state(path).state_hash(); });
}
