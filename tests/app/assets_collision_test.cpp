// The shapes that collide, by `rubble assets check` and `show`: cut, simplified, kept on disk, or refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "tests/app/own_pack.h"

namespace rubble::testing {
namespace assets_collision_test {

using Json = nlohmann::json;

// A table's legs: one hull would fill the space below it.
TEST(AssetsCheck, DecomposesAndKeepsThePartsOnDisk) {
  const ScratchFolder scratch;
  std::string obj;
  int first = 1;
  const auto box = [&](double x0, double y0, double z0, double x1, double y1, double z1) {
    for (int i = 0; i < 8; ++i)
      obj += "v " + std::to_string(i & 1 ? x1 : x0) + " " + std::to_string(i & 2 ? y1 : y0) + " " +
             std::to_string(i & 4 ? z1 : z0) + "\n";
    for (const auto& f : kBoxFaces)
      obj += "f " + std::to_string(f[0] + first) + " " + std::to_string(f[1] + first) + " " +
             std::to_string(f[2] + first) + "\n";
    first += 8;
  };
  box(0, 0, 0.7, 1.2, 0.8, 0.75);
  for (const double x : {0.0, 1.12})
    for (const double y : {0.0, 0.72}) box(x, y, 0, x + 0.08, y + 0.08, 0.7);
  write_file(scratch / "cube.obj", obj);
  const std::string cache = scratch / "cache";
  const auto check = [&](const std::string& collision) {
    write_file(scratch / "pack.lua", one_asset("collision = \"" + collision + "\""));
    const Outcome outcome = run_rubble("assets check --json " + scratch.path().string(),
                                       "RUBBLE_CACHE=" + cache);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out).at("assets")[0];
  };
  const Json hull = check("hull"), cut = check("decompose");
  EXPECT_GT(hull.at("parts_outside_mesh_m3"), 0.5);
  EXPECT_LT(cut.at("parts_outside_mesh_m3"), 0.01);
  EXPECT_LT(cut.at("mesh_outside_parts_m3"), 0.005);
  EXPECT_GE(cut.at("parts"), 5);
  EXPECT_EQ(cut.at("parts_farthest_from_mesh_m"), 0) << "boxes are cut without error";
  EXPECT_FALSE(hull.contains("parts_farthest_from_mesh_m"));

  // The second run reads what the first one kept; a damaged entry is noticed and made anew.
  std::vector<std::filesystem::path> entries;
  for (const auto& e : std::filesystem::recursive_directory_iterator(cache))
    if (e.is_regular_file()) entries.push_back(e.path());
  ASSERT_EQ(entries.size(), 1u);
  const std::string kept = read_file(entries[0]);
  EXPECT_EQ(check("decompose"), cut);
  std::string damaged = kept;
  damaged[damaged.size() / 2] ^= 1;
  write_file(entries[0], damaged);
  EXPECT_EQ(check("decompose"), cut);
  EXPECT_EQ(read_file(entries[0]), kept);
}

// Two boxes at a corner: one hull fills the corner, and the sheet of what collides shows it.
TEST(AssetsShow, DrawsThePartsThatCollide) {
  const ScratchFolder scratch;
  std::string l = "v 0 0 0\nv 1 0 0\nv 1 0 0.2\nv 0.2 0 0.2\nv 0.2 0 1\nv 0 0 1\n"
                  "v 0 0.3 0\nv 1 0.3 0\nv 1 0.3 0.2\nv 0.2 0.3 0.2\nv 0.2 0.3 1\nv 0 0.3 1\n"
                  "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 7 9 8\nf 7 10 9\nf 7 11 10\nf 7 12 11\n";
  for (int i = 1; i <= 6; ++i) {
    const std::string a = std::to_string(i), b = std::to_string(i % 6 + 1);
    const std::string c = std::to_string(i + 6), d = std::to_string(i % 6 + 7);
    l += "f " + a + " " + c + " " + d + "\nf " + a + " " + d + " " + b + "\n";
  }
  write_file(scratch / "cube.obj", l);
  const auto show = [&](const std::string& collision, const std::string& option) {
    write_file(scratch / "pack.lua", one_asset("collision = \"" + collision + "\""));
    const std::string out = scratch / (collision + option + ".png");
    const Outcome shown = run_rubble("assets show " + scratch.path().string() + " --out " + out + " " + option);
    EXPECT_EQ(shown.exit_code, 0) << shown.err;
    return read_file(out);
  };
  const std::string mesh = show("hull", ""), hull = show("hull", "--collision");
  const std::string cut = show("decompose", "--collision");
  EXPECT_EQ(show("decompose", ""), mesh) << "without --collision the mesh is drawn";
  EXPECT_NE(hull, mesh);
  EXPECT_NE(cut, hull);
  const Outcome checked = run_rubble("assets check --json " + scratch.path().string());
  const Json asset = Json::parse(checked.out).at("assets")[0];
  EXPECT_EQ(asset.at("parts"), 2);
  EXPECT_NEAR(asset.at("parts_outside_mesh_m3"), 0, 1e-6);
}

// A thin wide bowl: no few convex parts follow it. The advice is another than the option that is set.
TEST(AssetsCheck, WarnsWherePartsHoldMuchMoreThanTheMesh) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 4, sides = 16;
  for (const double radius : {1.0, 0.97})
    for (int i = 0; i <= rings; ++i)
      for (int k = 0; k < sides; ++k) {
        const double down = 1.5707963 * i / rings, round = 6.2831853 * k / sides;
        obj += "v " + std::to_string(radius * std::sin(down) * std::cos(round)) + " " +
               std::to_string(radius * std::sin(down) * std::sin(round)) + " " + std::to_string(-radius * std::cos(down)) + "\n";
      }
  const auto at = [&](int shell, int ring, int k) {
    return std::to_string((shell * (rings + 1) + ring) * sides + (ring == 0 ? 0 : k % sides) + 1);
  };
  const auto face = [&](const std::string& a, const std::string& b, const std::string& c) {
    if (a != b && b != c && c != a) obj += "f " + a + " " + b + " " + c + "\n";
  };
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i < rings; ++i) {
      face(at(0, i, k), at(0, i + 1, k + 1), at(0, i + 1, k)), face(at(0, i, k), at(0, i, k + 1), at(0, i + 1, k + 1));
      face(at(1, i, k), at(1, i + 1, k), at(1, i + 1, k + 1)), face(at(1, i, k), at(1, i + 1, k + 1), at(1, i, k + 1));
    }
    face(at(0, rings, k), at(0, rings, k + 1), at(1, rings, k + 1)), face(at(0, rings, k), at(1, rings, k + 1), at(1, rings, k));
  }
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"decompose\""));
  const Outcome outcome = run_rubble("assets check " + scratch.path().string());
  EXPECT_NE(outcome.out.find("% more than the mesh and stand out of it by up to"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("collision = { parts = FILE }"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("try collision"), std::string::npos) << outcome.out;
}

// In map coordinates: rounded to half a metre, another shape.
TEST(AssetsCheck, RefusesAMeshInMapCoordinates) {
  const ScratchFolder scratch;
  std::string obj;
  for (int i = 0; i < 8; ++i)
    obj += "v " + std::to_string(358123.25 + (i & 1)) + " " + std::to_string(4512345.75 + (i >> 1 & 1)) + " " +
           std::to_string(i >> 2) + "\n";
  for (const auto& f : kBoxFaces)
    obj += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " + std::to_string(f[2] + 1) + "\n";
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check " + scratch.path().string());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("lies too far from its origin"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("subtract about (35812"), std::string::npos) << outcome.out;
}

// A ball of 1,200 corners.
TEST(AssetsCheck, SimplifiesAHullOfMoreCornersThanAPartMayHave) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 30, sides = 40;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const double z = 3.14159265358979 * (i + 0.5) / rings, round = 6.28318530717959 * k / sides;
      obj += "v " + std::to_string(0.5 * std::sin(z) * std::cos(round)) + " " + std::to_string(0.5 * std::sin(z) * std::sin(round)) +
             " " + std::to_string(0.5 * std::cos(z)) + "\n";
    }
  const auto at = [&](int i, int k) { return std::to_string(i * sides + k % sides + 1); };
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i + 1 < rings; ++i)
      obj += "f " + at(i, k) + " " + at(i + 1, k) + " " + at(i + 1, k + 1) + "\nf " + at(i, k) + " " + at(i + 1, k + 1) + " " +
             at(i, k + 1) + "\n";
    if (k > 1)
      obj += "f " + at(0, 0) + " " + at(0, k - 1) + " " + at(0, k) + "\nf " + at(rings - 1, 0) + " " + at(rings - 1, k) + " " +
             at(rings - 1, k - 1) + "\n";
  }
  write_file(scratch / "cube.obj", obj);
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check --json " + scratch.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const Json ball = Json::parse(outcome.out).at("assets")[0];
  EXPECT_LE(ball.at("most_corners"), 1000);
  EXPECT_LT(ball.at("mesh_outside_parts_m3"), 0.01 * double(ball.at("volume_m3")));
  EXPECT_NE(ball.at("warnings").dump().find("more than the 1000 that a part may have"), std::string::npos);
}

// A drum of 530 sides, with more points than corners: each corner stands out by a millionth of its size.
TEST(AssetsCheck, SimplifiesAHullWhoseCornersHardlyStandOut) {
  const ScratchFolder scratch;
  std::string obj;
  const int rings = 10, sides = 530;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      char line[96];
      const double round = 6.28318530717959 * k / sides;
      std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", 0.5 * std::cos(round), 0.5 * std::sin(round), 0.1 * i);
      obj += line;
    }
  const auto at = [&](int i, int k) { return " " + std::to_string(i * sides + k % sides + 1); };
  std::string bottom = "f", top = "f";
  for (int k = 0; k < sides; ++k) {
    for (int i = 0; i + 1 < rings; ++i) obj += "f" + at(i, k) + at(i, k + 1) + at(i + 1, k + 1) + at(i + 1, k) + "\n";
    bottom += at(0, sides - k), top += at(rings - 1, k);
  }
  write_file(scratch / "cube.obj", obj + bottom + "\n" + top + "\n");
  write_file(scratch / "pack.lua", one_asset("collision = \"hull\""));
  const Outcome outcome = run_rubble("assets check --json " + scratch.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const Json drum = Json::parse(outcome.out).at("assets")[0];
  EXPECT_LE(drum.at("most_corners"), 1000);
  EXPECT_NE(drum.at("warnings").dump().find("its hull has 1060 corners"), std::string::npos) << drum.at("warnings");
}

}  // namespace assets_collision_test
}  // namespace rubble::testing
