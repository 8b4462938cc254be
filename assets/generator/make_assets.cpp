// rubble_make_assets FOLDER [PACK]: writes the bundled packs, or one, a folder each, into FOLDER.
#include <exception>
#include <iostream>
#include <string>

#include "assets/generator/asset.h"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: rubble_make_assets FOLDER [PACK]\n";
    return 1;
  }
  try {
    bool found = false;
    for (const std::string& name : rubble::generator::pack_names()) {
      if (argc == 3 && name != argv[2]) continue;
      found = true;
      rubble::generator::write_pack(rubble::generator::make_pack(name), std::string(argv[1]) + "/" + name);
    }
    if (found) return 0;
    std::cerr << "rubble_make_assets: no pack `" << argv[2] << "`\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "rubble_make_assets: " << error.what() << "\n";
    return 2;
  }
}
