// Packs that a test writes, and what `rubble assets check` says of them.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program.h"

namespace rubble::testing {

inline nlohmann::json check_json(const std::string& pack, int exit_code = 0) {
  const Outcome check = run_rubble("assets check --json " + pack);
  EXPECT_EQ(check.exit_code, exit_code) << check.err;
  return nlohmann::json::parse(check.out);
}

// A cube of side `size` as an OBJ file; open: without its top.
inline std::string cube_obj(double size, bool open = false) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(i >> axis & 1 ? size : 0.0);
    text += "\n";
  }
  text += "f 1 3 4 2\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
  return open ? text : text + "f 5 6 8 7\n";
}

inline std::string one_asset(const std::string& keys) {
  return "return pack { name = \"own\", assets = { { name = \"cube\", mesh = \"cube.obj\", " + keys +
         " } } }\n";
}

// Of a box whose corner i has the bits of i as its coordinates.
inline constexpr int kBoxFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                         {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

}  // namespace rubble::testing
