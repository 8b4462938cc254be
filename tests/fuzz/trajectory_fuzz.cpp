#include "scripting/trajectory/trajectory_text.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  fuzz::knock([&] { parse_trajectory(bytes, "t"); });
  fuzz::knock([&] { parse_trajectory(bytes, "t", "t,x,y,z,qx,qy,qz,qw"); });
}
