// rubble_make_assets FOLDER: writes the bundled packs, one folder each, into FOLDER.
#include <exception>
#include <iostream>
#include <string>

#include "assets/generator/asset.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: rubble_make_assets FOLDER\n";
    return 1;
  }
  try {
    const rubble::generator::Pack pack = rubble::generator::concrete_pack();
    rubble::generator::write_pack(pack, std::string(argv[1]) + "/" + pack.name);
  } catch (const std::exception& error) {
    std::cerr << "rubble_make_assets: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
