// Void maps as files, read back by the libraries that own the formats.
#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/voids/void_files.h"
#include "kernel/base/mesh.h"
#include "void_scenes.h"

namespace rubble {
namespace void_files_test {

std::string make_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rubble-voids-XXXXXX").string();
  return mkdtemp(pattern.data());
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// A closed room of 1.6 x 1.2 x 0.8 m and its void for a robot of 0.2 m.
class VoidFiles : public ::testing::Test {
 protected:
  static VoidMap make_map() {
    testing::VoidScene scene;
    testing::add_room(scene, {0.01, 0.02, 0}, {1.61, 1.22, 0.8}, 0.1);
    VoidSpaceOptions options;
    options.voxel = 0.04;
    options.rolling_radius = 0.5;
    return find_voids(calc_void_space(scene.pile, scene.pointers(), options), {0.2});
  }
  static void SetUpTestSuite() {
    folder_ = make_folder();
    map_ = std::make_unique<VoidMap>(make_map());
  }
  static void TearDownTestSuite() {
    std::filesystem::remove_all(folder_);
    map_.reset();
  }
  static std::string folder_;
  static std::unique_ptr<VoidMap> map_;
};
std::string VoidFiles::folder_;
std::unique_ptr<VoidMap> VoidFiles::map_;

TEST_F(VoidFiles, OpenVdbReadsTheClearanceWhereItIs) {
  const std::string path = folder_ + "/voids.vdb";
  write_vdb(path, *map_);
  openvdb::initialize();
  std::istringstream bytes(read_file(path));
  openvdb::io::Stream stream(bytes);
  const auto grids = stream.getGrids();
  ASSERT_EQ(grids->size(), 4u);
  std::vector<std::string> names;
  for (const auto& grid : *grids) names.push_back(grid->getName());
  EXPECT_EQ(names, (std::vector<std::string>{"clearance", "widest_path", "solid", "voids_r200"}));

  const auto clearance = openvdb::gridPtrCast<openvdb::FloatGrid>((*grids)[0]);
  const auto solid = openvdb::gridPtrCast<openvdb::BoolGrid>((*grids)[2]);
  const auto labels = openvdb::gridPtrCast<openvdb::Int32Grid>((*grids)[3]);
  const VoidSpace& space = map_->space;
  for (std::size_t i = 0; i < space.kind.size(); i += 7) {
    const Vec3 p = space.grid.centre(i);
    const auto at = openvdb::Coord::round(clearance->worldToIndex({p.x, p.y, p.z}));
    const bool is_void = space.kind[i] == CellKind::free_void;
    ASSERT_EQ(clearance->tree().getValue(at), is_void ? space.clearance[i] : 0.0f);
    ASSERT_EQ(solid->tree().getValue(at), space.kind[i] == CellKind::solid);
  }
  EXPECT_EQ(labels->activeVoxelCount(), map_->robots[0].voids[0].cells.size());
}

TEST_F(VoidFiles, VdbHasTheSameBytesEachTime) {
  write_vdb(folder_ + "/a.vdb", *map_);
  write_vdb(folder_ + "/b.vdb", make_map());
  EXPECT_EQ(read_file(folder_ + "/a.vdb"), read_file(folder_ + "/b.vdb"));
  VoidMap other = make_map();
  const std::size_t cell = map_->robots[0].voids[0].cells[0];
  other.space.clearance.set(cell, other.space.clearance[cell] + 1e-6f);
  write_vdb(folder_ + "/c.vdb", other);
  EXPECT_NE(read_file(folder_ + "/a.vdb").substr(0, 60), read_file(folder_ + "/c.vdb").substr(0, 60))
      << "the UUID follows the content";
}

TEST_F(VoidFiles, OctoMapKnowsSolidFromVoid) {
  const std::string path = folder_ + "/voids.bt";
  write_octomap(path, map_->space);
  octomap::OcTree tree(path);
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.04);
  const VoidSpace& space = map_->space;
  for (std::size_t i = 0; i < space.kind.size(); i += 11) {
    const Vec3 p = space.grid.centre(i);
    const octomap::OcTreeNode* node = tree.search(p.x, p.y, p.z);
    if (space.kind[i] == CellKind::outside) {
      ASSERT_EQ(node, nullptr);
    } else {
      ASSERT_NE(node, nullptr);
      ASSERT_EQ(tree.isNodeOccupied(node), space.kind[i] == CellKind::solid);
    }
  }
}

// The tree that OctoMap makes of the same voxels, pruned and written by itself.
TEST_F(VoidFiles, OctoMapWouldHaveWrittenTheSame) {
  const VoidSpace& space = map_->space;
  octomap::OcTree tree(space.grid.voxel);
  for (std::size_t i = 0; i < space.kind.size(); ++i) {
    if (space.kind[i] == CellKind::outside) continue;
    const Vec3 p = space.grid.centre(i);
    tree.setNodeValue(octomap::point3d(float(p.x), float(p.y), float(p.z)),
                      space.kind[i] == CellKind::solid ? 1.0f : -1.0f, true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream theirs(std::ios::binary);
  tree.writeBinaryData(theirs);
  write_octomap(folder_ + "/same.bt", space);
  const std::string ours = read_file(folder_ + "/same.bt");
  const std::size_t data = ours.find("data\n") + 5;
  EXPECT_GT(theirs.str().size(), 1000u);
  EXPECT_TRUE(ours.substr(data) == theirs.str());
  EXPECT_NE(ours.find("\nsize " + std::to_string(tree.size()) + "\n"), std::string::npos);
}

TEST_F(VoidFiles, TheSurfaceOfAVoidHoldsItsVolume) {
  const Void& v = map_->robots[0].voids[0];
  const TriangleMesh mesh = make_void_surface(map_->space, v);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(calc_volume_properties(mesh).volume, v.volume, 0.03 * v.volume) << "outward";

  write_void_surface(folder_ + "/void.ply", mesh, 0x1234);
  EXPECT_TRUE(is_void_surface_of(folder_ + "/void.ply", 0x1234));
  EXPECT_FALSE(is_void_surface_of(folder_ + "/void.ply", 0x1235));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder_ + "/void.ply", aiProcess_JoinIdenticalVertices);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  EXPECT_EQ(scene->mMeshes[0]->mNumFaces, mesh.triangles.size());
  EXPECT_EQ(scene->mMeshes[0]->mNumVertices, mesh.positions.size());
}

TEST_F(VoidFiles, JsonHoldsTheVoidsAndTheGraph) {
  const auto json = nlohmann::json::parse(make_void_json(*map_));
  EXPECT_EQ(json["robots"].size(), 1u);
  const auto& robot = json["robots"][0];
  EXPECT_EQ(robot["radius"], 0.2);
  ASSERT_EQ(robot["voids"].size(), 1u);
  EXPECT_EQ(robot["reachable_share"], 0);
  EXPECT_TRUE(robot["voids"][0]["entrances"].empty());
  EXPECT_TRUE(robot["voids"][0]["bottleneck"].is_null());
  EXPECT_NEAR(robot["voids"][0]["widest_radius"].get<double>(), 0.4, 0.04);
  EXPECT_NEAR(json["void_volume"].get<double>(), 1.6 * 1.2 * 0.8, 0.08);
  EXPECT_EQ(json["graph"]["chambers"].size(), 1u);
}

// How many pixels of a picture are solid (grey) in the middle half.
int count_grey(const RgbImage& image) {
  int grey = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    grey += image.rgb[i] == 96 && image.rgb[i + 1] == 92 && image.rgb[i + 2] == 88;
  return grey;
}

TEST_F(VoidFiles, PicturesShowTheCut) {
  const RgbImage cut = draw_void_cut(*map_, 0, 1, {0.8, 0.6, 0.4});
  EXPECT_EQ(cut.rgb.size(), std::size_t(cut.width) * std::size_t(cut.height) * 3);
  // Two walls of 0.1 m and the roof: their share of the cut, in pixels of the drawing.
  const double metre = 1400 / 3.0;  // about 1.8 m and a margin, at 1400 pixels
  EXPECT_GT(count_grey(cut), 0.2 * metre * metre);
  const RgbImage plan = draw_void_plan(*map_, 0);
  EXPECT_GT(plan.width, 600);
}

}  // namespace void_files_test
}  // namespace rubble
