// Brings the reference in docs/reference/missions.md up to date: rubble_write_reference docs/reference/missions.md
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>

#include "scripting/reference/schema_docs.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: rubble_write_reference FILE\n"), 1;
  try {
    std::ostringstream text;
    text << std::ifstream(argv[1]).rdbuf();
    const std::string document = rubble::with_reference(text.str());
    std::ofstream out(argv[1]);
    out << document;
    out.close();
    return out ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
    return 1;
  }
}
