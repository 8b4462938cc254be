#include "bench/workload_file.h"

#include <gtest/gtest.h>

#include "kernel/base/error.h"

namespace rubble {
namespace workload_file_test {

const char* const kTetra =
    "shapes 1\n"
    "shape tetra 4\n"
    "0 0 0\n"
    "1 0 0\n"
    "0 1 0\n"
    "0 0 1e0\n";

std::string complaint(const std::string& text) {
  try {
    parse_workload(text, "x.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(WorkloadFile, ReadsShapesAndLayers) {
  const Pile pile = parse_workload(std::string(kTetra) +
                                       "layer 2\n"
                                       "0 0.5 1 2 3 1 0 0 0\n"
                                       "0 2 -1 -2 4.25 0 0 0.6 0.8\n"
                                       "layer 0\n",
                                   "x.txt");
  ASSERT_EQ(pile.types.size(), 1U);
  EXPECT_EQ(pile.types[0].name, "tetra");
  EXPECT_EQ(pile.types[0].density, 2300);
  EXPECT_EQ(pile.types[0].friction, 0.6);
  ASSERT_EQ(pile.types[0].parts.size(), 1U);
  EXPECT_EQ(pile.types[0].parts[0].points[3], (Vec3{0, 0, 1}));
  ASSERT_EQ(pile.layers.size(), 2U);
  ASSERT_EQ(pile.layers[0].pieces.size(), 2U);
  const Placement& piece = pile.layers[0].pieces[1];
  EXPECT_EQ(piece.scale, 2);
  EXPECT_EQ(piece.world_from_body.translation, (Vec3{-1, -2, 4.25}));
  EXPECT_NEAR(piece.world_from_body.rotation.y, 0.6, 1e-15);
  EXPECT_NEAR(piece.world_from_body.rotation.z, 0.8, 1e-15);
}

TEST(WorkloadFile, ReadsATerrain) {
  const Pile pile = parse_workload(std::string(kTetra) + "terrain 3 2 2\n0 1 0\n0 0 3\nlayer 1\n0 1 0 0 9 1 0 0 0\n", "x.txt");
  ASSERT_EQ(pile.types.size(), 2U);
  ASSERT_EQ(pile.placed.size(), 1U);
  EXPECT_TRUE(pile.placed[0].fixed);
  EXPECT_EQ(pile.placed[0].kind.index, 1);
  const TriangleMesh& mesh = *pile.types[1].surface;
  ASSERT_EQ(mesh.positions.size(), 6U);
  EXPECT_EQ(mesh.positions[1], (Vec3f{0, -1, 1}));
  EXPECT_EQ(mesh.positions[5], (Vec3f{2, 1, 3}));
  ASSERT_EQ(mesh.triangles.size(), 4U);
  for (const auto& t : mesh.triangles) {  // seen from above
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    EXPECT_GT(cross(b - a, c - a).z, 0);
  }
}

TEST(WorkloadFile, NamesFileAndLineOfAMistake) {
  const std::string hint = " (the format is described in bench/workloads/README.md)";
  EXPECT_EQ(complaint(""),
            "x.txt:1: ends too early: expected shapes, found the end of the file" + hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "terrain 3 1 2\n0 0 0\n"),
            "x.txt:7: out of range: expected a number of rows from 2 to 2000, found 1" + hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "layer 0\nterrain 2 2 1\n0 0 0 0\n"),
            "x.txt:8: wrong record: expected layer, found \"terrain\"" + hint);
  EXPECT_EQ(complaint("shapes 1\nshape a 4\n0 0 zero\n"),
            "x.txt:3: not a number: expected a coordinate of a corner, found \"zero\"" + hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "layer 1\n1 1 0 0 0 1 0 0 0\n"),
            "x.txt:8: out of range: expected the index of a shape, 0 to 0, found 1" + hint);
  EXPECT_EQ(
      complaint(std::string(kTetra) + "layer 1\n0 1 0 0 0 1 1 0 0\n"),
      "x.txt:8: not a rotation: expected a quaternion of length 1, found the length 1.41421" +
          hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "layer 1\n0 -1 0 0 0 1 0 0 0\n"),
            "x.txt:8: out of range: expected a scale above 0, found -1" + hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "layer 1\n0 1 nan 0 0 1 0 0 0\n"),
            "x.txt:8: not finite: expected a position, found nan" + hint);
  EXPECT_EQ(complaint(std::string(kTetra) + "lair 1\n"),
            "x.txt:7: wrong record: expected layer, found \"lair\"" + hint);
  EXPECT_EQ(complaint("shapes 1\nshape a 3\n"),
            "x.txt:2: out of range: expected a number of corners from 4 to 100000, found 3" + hint);
}

TEST(WorkloadFile, ThatDoesNotExistIsAnInputError) {
  EXPECT_THROW(load_workload("/nowhere/w1.txt"), InputError);
}

TEST(WorkloadFile, StandardWorkHasItsPieces) {
  const Pile pile = load_workload(RUBBLE_WORKLOADS "/w1.txt");
  EXPECT_EQ(pile.types.size(), 12U);
  ASSERT_EQ(pile.layers.size(), 4U);
  for (const Layer& layer : pile.layers) EXPECT_EQ(layer.pieces.size(), 300U);
}

TEST(TurnPieces, DrawsOrientationsFromTheSeedAlone) {
  const Pile file = load_workload(RUBBLE_WORKLOADS "/w0.txt");
  Pile a = file, b = file, c = file;
  turn_pieces(a, 7);
  turn_pieces(b, 7);
  turn_pieces(c, 8);
  for (std::size_t i = 0; i < file.layers[0].pieces.size(); ++i) {
    const Pose& pose = a.layers[0].pieces[i].world_from_body;
    EXPECT_EQ(pose.rotation, b.layers[0].pieces[i].world_from_body.rotation);
    EXPECT_FALSE(pose.rotation == c.layers[0].pieces[i].world_from_body.rotation);
    EXPECT_EQ(pose.translation, file.layers[0].pieces[i].world_from_body.translation);
  }
}

}  // namespace workload_file_test
}  // namespace rubble
