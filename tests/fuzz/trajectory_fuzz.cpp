#include "app/eval/scores/trajectory_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  const std::string path = fuzz::folder().write("t.txt", bytes);
  fuzz::knock([&] { load_trajectory(path); });
}
