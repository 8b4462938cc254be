// Files of scenes for simulators: shapes, heights, pictures, what each format cannot hold, what the next export removes.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "io/scenes/surface_heights.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/parts.h"
#include "tests/io/sim_scenes.h"

namespace rubble {
namespace sim_scene_test {

using test::ScratchFolder;

TEST_F(SimScenes, PrincipalInertiaOfATurnedBox) {
  const Quat turn = portable::quat_from_rpy(0.4, -1.1, 2.5);
  const Mat3 r = turn.matrix();
  const Mat3 inertia = r * Mat3::diagonal({1, 3, 7}) * r.transposed();
  const PrincipalInertia found = calc_principal_inertia(inertia);
  const Mat3 axes = found.link_from_principal.matrix();
  const Mat3 again = axes * Mat3::diagonal(found.moments) * axes.transposed();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(again.rows[i][j], inertia.rows[i][j], 1e-12);
  double sorted[3] = {found.moments.x, found.moments.y, found.moments.z};
  std::sort(sorted, sorted + 3);
  EXPECT_NEAR(sorted[0], 1, 1e-12);
  EXPECT_NEAR(sorted[2], 7, 1e-12);
}

TEST_F(SimScenes, BoxesAreFoundAndNothingElseIs) {
  const Pose pose{portable::quat_from_rpy(0.4, -1.1, 2.5), {1, 2, 3}};
  std::vector<Vec3> corners;
  for (const Vec3& p : make_box({0.4, 2, 6}).points) corners.push_back(pose * p);
  const auto box = find_box(calc_hull(corners));
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->size.x * box->size.y * box->size.z, 0.4 * 2 * 6, 1e-9);
  EXPECT_LT(distance(box->shape_from_box.translation, pose.translation), 1e-9);
  for (const Vec3& corner : corners) {
    const Vec3 in_box = box->shape_from_box.inverse() * corner;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(in_box[i]), 0.5 * box->size[i], 1e-9);
  }
  corners[0] += Vec3{0.01, 0, 0};
  EXPECT_FALSE(find_box(calc_hull(corners))) << "a corner is 1 cm away";
  EXPECT_FALSE(find_box(model_.sim.shapes[1].hulls[0])) << "a tetrahedron";
}

// A part of a bundled girder, of which two merged faces share three corners: their fans would have a triangle twice.
TEST_F(SimScenes, ConvexPartsAreClosedAndConvex) {
  const Hull part = calc_hull({{-1.49918, 0.09673, 0.11858}, {-1.49918, 0.10937, 0.1199},   {-0.90048, 0.08921, 0.17706},
                               {-0.90048, -0.10798, 0.15645}, {-0.96182, -0.10586, 0.15059}, {-1.49918, -0.08817, 0.14374},
                               {-0.90048, -0.10812, 0.1632},  {-0.90048, 0.08906, 0.18381},  {-0.97961, 0.09162, 0.18123},
                               {-1.49918, -0.06952, 0.14569}, {-1.49918, -0.08778, 0.13312}, {-1.49918, 0.10909, 0.13161},
                               {-1.4336, 0.10691, 0.13787},   {-1.01809, -0.10399, 0.14877}, {-1.33622, -0.09365, 0.14903}});
  std::map<std::pair<int, int>, int> edges;
  double six = 0;
  for (const std::array<int, 3>& t : calc_hull_triangles(part)) {
    const auto at = [&](int i) { return part.points[std::size_t(t[std::size_t(i)])]; };
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
    six += dot(at(0), normal);
    for (const Vec3& p : part.points) EXPECT_LT(dot(normal, p - at(0)), 1e-5 * norm(normal)) << "a corner over a face";
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_NEAR(six / 6, calc_volume(part), 1e-3 * calc_volume(part));
}

TEST_F(SimScenes, HeightsAreThoseOfTheSurface) {
  const SurfaceHeights heights = calc_surface_heights(model_.sim.surfaces, 0.1);
  ASSERT_EQ(heights.columns, 21);
  ASSERT_EQ(heights.rows, 41);
  EXPECT_NEAR(heights.low.x, 19, 1e-9);
  for (const float share : heights.shares) EXPECT_NEAR(heights.low.z + heights.range * double(share), 0.25, 1e-6);
  EXPECT_EQ(calc_surface_heights({}, 0.1).columns, 0);
}

// A picture of a mesh goes beside the scene, and its places into the mesh.
TEST_F(SimScenes, PicturesGoBesideTheScene) {
  SurfacePaint paint;
  paint.albedo.side = 2;
  paint.albedo.texels.assign(16, 200);
  slab_.surface_names = {"poster"};
  slab_.paints = {std::make_shared<const SurfacePaint>(paint)};
  slab_.paint_corners.assign(slab_.triangles.size(), {PaintCorner{0, 0, {1, 1, 1}}, {1, 0, {1, 1, 1}}, {0.5f, 1, {1, 1, 1}}});
  for (const MeshFormat& format : mesh_formats()) {
    if (!format.is_folder) continue;
    const std::string folder = write(format.name);
    EXPECT_TRUE(std::filesystem::exists(folder + "/meshes/poster.png")) << format.name;
    const std::string all = test::read_tree(folder);
    for (const char* part : {"poster.png"}) EXPECT_NE(all.find(part), std::string::npos) << format.name;
    EXPECT_NE(all.find(format.name == "usd" ? "(0.5, 1)" : "vt 0.5 1\n"), std::string::npos) << format.name;
  }
}

// A surface of that name without a picture has a material of its own.
TEST_F(SimScenes, PicturesOfGlbHavePlaces) {
  SurfacePaint paint;
  paint.albedo.side = 2;
  paint.albedo.texels.assign(16, 200);
  slab_.surface_names = {"rebar"};  // as that of the spikes
  slab_.paints = {std::make_shared<const SurfacePaint>(paint)};
  slab_.paint_corners.assign(slab_.triangles.size(), {PaintCorner{0, 0, {1, 1, 1}}, {1, 0, {1, 1, 1}}, {0.5f, 1, {1, 1, 1}}});
  export_pile(model_, "glb", folder_.path());
  const std::string bytes = test::read_text(folder_ / "pile.glb");
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const auto document = nlohmann::json::parse(bytes.substr(20, size));
  int pictured = 0, plain = 0;
  for (const auto& mesh : document["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      const auto& look = document["materials"][primitive["material"].get<std::size_t>()]["pbrMetallicRoughness"];
      const bool picture = look.contains("baseColorTexture");
      EXPECT_EQ(picture, primitive["attributes"].contains("TEXCOORD_0")) << mesh["name"];
      ++(picture ? pictured : plain);
    }
  EXPECT_EQ(pictured, 1);
  EXPECT_EQ(plain, 1);
}

TEST_F(SimScenes, EachFormatSaysWhatItCannotHold) {
  const auto holds = [](const std::vector<std::string>& said, const char* part) {
    return std::any_of(said.begin(), said.end(), [&](const std::string& s) { return s.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(holds(mjcf_limits(model_.sim), "height field"));
  EXPECT_TRUE(holds(mjcf_limits(model_.sim), "1 joint of the kind ball"));
  EXPECT_TRUE(holds(urdf_limits(model_.sim), "three hinges"));
  EXPECT_TRUE(holds(usd_limits(model_.sim), "dry friction"));
  model_.sim.models.clear(), model_.sim.surfaces.clear(), model_.sim.cameras.clear();
  for (const MeshFormat& format : mesh_formats())
    EXPECT_TRUE(!format.limits || format.limits(model_.sim).empty()) << format.name;
}

// Readers that split corners by their normals, such as trimesh, find closed meshes all the same.
TEST_F(SimScenes, CornersOfFlatMeshesAreShared) {
  for (const char* format : {"sdf", "urdf"}) {
    const std::string text = test::read_text(write(format) + "/meshes/slab.obj");
    EXPECT_EQ(text.find("vn "), std::string::npos);
    std::size_t corners = 0;
    for (std::size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) ++corners;
    EXPECT_EQ(corners, 8u);
  }
}

// `rubble export --force` removes what it knows; what else is there is somebody's, and refuses the export.
TEST_F(SimScenes, TheNextExportKnowsEveryFileAndFolder) {
  for (const bool empty : {false, true}) {
    if (empty) model_.sim = {};
    ScratchFolder folder;
    for (const MeshFormat& format : mesh_formats()) {
      if (!format.is_folder) continue;
      export_pile(model_, format.name, folder.path());
      const std::string whole = folder / format.name;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(whole)) {
        const std::string name = std::filesystem::relative(entry.path(), whole).string();
        if (entry.is_directory())
          EXPECT_FALSE(std::filesystem::is_empty(entry.path())) << format.name << ": " << name;
        else
          EXPECT_TRUE(is_scene_file(name)) << format.name << ": " << name;
      }
    }
  }
}

}  // namespace sim_scene_test
}  // namespace rubble
