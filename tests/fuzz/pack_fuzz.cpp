#include "scripting/packs/asset_pack.h"
#include "tests/fuzz/fuzz_file.h"

using namespace rubble;

void fuzz_one(std::string_view bytes) {
  fuzz::folder().write("pack.lua", bytes);
  fuzz::folder().write("a.obj", "");
  fuzz::knock([&] { load_asset_pack(fuzz::folder().path(), {{"brick", 1900, 0.6, "", "brick"}}); });
}
