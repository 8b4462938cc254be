#include "tests/fuzz/fuzz_mesh.h"

void fuzz_one(std::string_view bytes) { rubble::fuzz::read_mesh("a.ply", bytes); }
