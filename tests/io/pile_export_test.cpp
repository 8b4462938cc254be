// Exports of a small pile, read back by assimp, Gazebo's SDF parser, Khronos's glTF validator,
// ADMesh and meshio.
#include "io/scenes/pile_export.h"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#if __has_include(<sdf/sdf.hh>)
#include <sdf/sdf.hh>
#endif

#include "io/mesh/mesh_file.h"
#include "io/mesh/mesh_writers.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/model/track_builder.h"
#include "tests/io/all_recorders.h"
#include "tests/io/small_scene.h"
#include "tests/io/support.h"

namespace rubble {
namespace pile_export_test {

using test::ScratchFolder;

// A wedge with normals and two surfaces: no symmetry that could hide a mirrored axis.
TriangleMesh make_wedge() {
  const Vec3f corners[] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}};
  const std::array<int, 3> faces[] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  TriangleMesh mesh;
  mesh.surface_names = {"concrete_cast", "brick"};
  for (const auto& f : faces) {
    const Vec3f a = corners[f[0]], b = corners[f[1]], c = corners[f[2]];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3f normal = normalized(cross(b - a, c - a));
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.normals.insert(mesh.normals.end(), {normal, normal, normal});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.surfaces.push_back(mesh.surfaces.size() < 2 ? 0 : 1);
  }
  return mesh;
}

class PileExport : public ::testing::Test {
 protected:
  PileExport() {
    model_.types = {{"wedge", &wedge_}, {"spike", &spike_}};
    model_.pieces = {
        {0, piece_name("wedge", 0), 1.5, {portable::quat_from_rpy(0.3, -0.7, 1.9), {1, 2, 3}}},
        {1, piece_name("spike", 1), 0.5, {portable::quat_from_rpy(-2.0, 0.4, 0.1), {-4, 0, 0.2}}},
        {0, piece_name("wedge", 7), 2.0, {portable::quat_from_rpy(0, 0, -1), {0, -5, 0}}}};
    model_.surface_appearance = {{"concrete_cast", {0.3f, 0.25f, 0.2f}},
                                 {"brick", {0.4f, 0.1f, 0.1f}}};
  }

  double expected_volume() const {
    const double wedge = 2.0 * 1.0 * 0.5 / 6, spike = 0.3 * 0.3 * 0.6 / 6;
    return wedge * (1.5 * 1.5 * 1.5 + 8.0) + spike * 0.125;
  }

  // Where a corner of the first piece must be.
  Vec3 expected_corner() const { return model_.pieces[0].world_from_body * (Vec3{2, 0, 0} * 1.5); }

  std::string write(const std::string& format) {
    names_ = export_pile(test::make_scene(model_), format, folder_.path());
    return folder_ / names_.back();
  }

  TriangleMesh wedge_ = make_wedge(), spike_ = test::make_flat_tetrahedron();
  PileModel model_;
  ScratchFolder folder_;
  std::vector<std::string> names_;
};

double nearest(const TriangleMesh& mesh, const Vec3& point) {
  double best = 1e9;
  for (const Vec3f& p : mesh.positions) best = std::min(best, distance(Vec3(p), point));
  return best;
}

// assimp takes OBJ, PLY and STL as they are, and glTF's Y for up.
TEST_F(PileExport, AssimpFindsTheSamePlacesCountsAndVolume) {
  for (const std::string format : {"stl", "ply", "obj", "glb"}) {
    const MeshUnits units{1, format == "glb" ? UpAxis::y : UpAxis::z};
    const TriangleMesh mesh = load_mesh(write(format), units);
    EXPECT_EQ(mesh.triangles.size(), 12u) << format;
    EXPECT_NEAR(calc_volume_properties(mesh).volume, expected_volume(), 1e-5) << format;
    EXPECT_TRUE(is_closed(mesh)) << format;
    EXPECT_LT(nearest(mesh, expected_corner()), 1e-6) << format;
    EXPECT_GT(nearest(mesh, {expected_corner().x, -expected_corner().y, expected_corner().z}), 0.1)
        << "the check would not see a mirrored " << format;
  }
}

TEST_F(PileExport, GlbKeepsNamesMaterialsAndOneMeshPerAsset) {
  const std::string path = write("glb");
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  EXPECT_EQ(scene->mNumMeshes, 3u) << "two surfaces of the wedge, one of the spike";
  for (const char* name : {"wedge_000000", "spike_000001", "wedge_000007"})
    EXPECT_TRUE(scene->mRootNode->FindNode(name)) << name;
  std::vector<std::string> materials;
  for (unsigned i = 0; i < scene->mNumMaterials; ++i)
    materials.push_back(scene->mMaterials[i]->GetName().C_Str());
  for (const char* name : {"concrete_cast", "brick", "rebar"})
    EXPECT_EQ(std::count(materials.begin(), materials.end(), name), 1) << name;
}

TEST_F(PileExport, KhronosValidatorFindsNothingInTheGlb) {
  const auto result = test::run_node("validate_gltf.mjs", write("glb"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("errors 0 warnings 0"), std::string::npos) << result.output;
}

// The first wedge falls and turns, the spike appears late and is lost, the last wedge stands.
Track make_track() {
  TrackBuilder builder;
  for (int i = 0; i <= 60; ++i) {
    const double t = i / 60.0;
    builder.begin_sample(t);
    builder.set({0, {}, {portable::quat_from_rpy(0.3, -0.7, 1.9 + 4 * t), {1, 2, 3 - 4.905 * t * t}},
                 {0, 0, -9.81 * t}, {0, 0, 4}});
    if (i >= 12 && i < 48)
      builder.set({1, {}, {portable::quat_from_rpy(-2.0, 0.4, 0.1), {-4 + t, 0, 0.2}}, {1, 0, 0}, {}});
    if (i == 48) builder.remove(1);
  }
  return builder.take();
}

class TrackGlb : public PileExport {
 protected:
  TrackGlb() {
    const std::int32_t numbers[] = {0, 1, 7};
    for (std::size_t i = 0; i < 3; ++i) model_.pieces[i].number = numbers[i];
    write_track_glb(folder_ / "track.glb", model_, track_);
  }
  Track track_ = make_track();
};

const aiNodeAnim* find_channel(const aiAnimation& clip, const std::string& node) {
  for (unsigned i = 0; i < clip.mNumChannels; ++i)
    if (node == clip.mChannels[i]->mNodeName.C_Str()) return clip.mChannels[i];
  return nullptr;
}

// As assimp understands it: where the pieces are at each key, in a world whose Y is up.
TEST_F(TrackGlb, AssimpReadsTheMotion) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder_ / "track.glb", 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumAnimations, 1u);
  const aiAnimation& clip = *scene->mAnimations[0];
  EXPECT_FALSE(find_channel(clip, "wedge_000007"));
  const aiNodeAnim* wedge = find_channel(clip, "wedge_000000");
  ASSERT_TRUE(wedge);
  const double ticks = clip.mTicksPerSecond;
  ASSERT_EQ(wedge->mNumPositionKeys, 61u);
  for (unsigned i = 0; i < wedge->mNumPositionKeys; ++i) {
    const auto motion = track_.motion_at(*track_.find(0), wedge->mPositionKeys[i].mTime / ticks);
    const Vec3 t = motion->world_from_body.translation;
    const aiVector3D& p = wedge->mPositionKeys[i].mValue;
    EXPECT_LT(distance(Vec3(double(p.x), double(p.y), double(p.z)), Vec3(t.x, t.z, -t.y)), 2e-5) << i;
    const aiQuaternion& q = wedge->mRotationKeys[i].mValue;
    const Quat turn{double(q.w), double(q.x), double(q.y), double(q.z)};
    const Vec3 x = motion->world_from_body.rotation.rotate({1, 0, 0});
    EXPECT_LT(distance(turn.rotate({1, 0, 0}), Vec3(x.x, x.z, -x.y)), 1e-4) << i;
  }
}

TEST_F(TrackGlb, HidesWhatIsNotThere) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder_ / "track.glb", 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  const aiNodeAnim* spike = find_channel(*scene->mAnimations[0], "spike_000001");
  ASSERT_TRUE(spike);
  const double ticks = scene->mAnimations[0]->mTicksPerSecond;
  const double times[] = {0, 0.2, 0.8}, sizes[] = {0, 0.5, 0};
  ASSERT_EQ(spike->mNumScalingKeys, 3u);
  for (unsigned i = 0; i < 3; ++i) {
    EXPECT_NEAR(spike->mScalingKeys[i].mTime / ticks, times[i], 1e-4);
    EXPECT_NEAR(double(spike->mScalingKeys[i].mValue.x), sizes[i], 1e-6);
  }
}

TEST_F(TrackGlb, KhronosValidatorFindsNothing) {
  const auto result = test::run_node("validate_gltf.mjs", folder_ / "track.glb");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("errors 0 warnings 0"), std::string::npos) << result.output;
}

// Images, colours of vertices, metal and relief go into the file and come back; Khronos' validator finds nothing wrong.
TEST_F(PileExport, GlbHasThePaintOfUsersMeshes) {
  SurfacePaint paint;
  paint.colour = {0.5f, 0.75f, 1}, paint.roughness = 0.5f, paint.metalness = 0.25f, paint.reflectance = 0.04f;
  paint.albedo.side = 4, paint.relief.side = 8;
  for (int i = 0; i < 4 * 16; ++i) paint.albedo.texels.push_back(i % 4 == 3 ? 255 : std::uint8_t(3 * i));
  for (int i = 0; i < 4 * 64; ++i) paint.relief.texels.push_back(std::uint8_t(100 + i % 50));
  paint.sha256 = "one";
  wedge_.surface_names[1] = "brick_one";
  wedge_.paints = {nullptr, std::make_shared<const SurfacePaint>(paint)};
  for (std::size_t t = 0; t < 4; ++t)
    wedge_.paint_corners.push_back({PaintCorner{0, 0.25f, {1, 0, 0}}, {1, 0.5f, {0, 1, 0}}, {2, 1, {0, 0, 0.5f}}});
  const std::string path = write("glb");
  const auto result = test::run_node("validate_gltf.mjs", path);
  EXPECT_NE(result.output.find("errors 0 warnings 0"), std::string::npos) << result.output;
  const TriangleMesh read = load_mesh(path, {1, UpAxis::y});
  const auto at = std::find(read.surface_names.begin(), read.surface_names.end(), "brick_one");
  ASSERT_NE(at, read.surface_names.end());
  const std::size_t surface = std::size_t(at - read.surface_names.begin());
  const SurfacePaint* found = read.paint_of(surface);
  ASSERT_TRUE(found);
  EXPECT_FLOAT_EQ(found->colour.y, 0.75f);
  EXPECT_FLOAT_EQ(found->roughness, 0.5f);
  EXPECT_FLOAT_EQ(found->metalness, 0.25f);
  EXPECT_EQ(found->albedo.texels, paint.albedo.texels);
  EXPECT_EQ(found->relief.texels, paint.relief.texels);
  const auto first = std::find(read.surfaces.begin(), read.surfaces.end(), surface) - read.surfaces.begin();
  const auto& corners = read.paint_corners[std::size_t(first)];
  EXPECT_FLOAT_EQ(corners[1].u, 1);
  EXPECT_FLOAT_EQ(corners[1].v, 0.5f);
  EXPECT_FLOAT_EQ(corners[2].colour.z, 0.5f);
}

TEST_F(PileExport, ObjKeepsNamesAndMaterials) {
  const std::string text = test::read_text(write("obj"));
  for (const char* line : {"mtllib pile.mtl\n", "o wedge_000000\n", "o spike_000001\n",
                           "o wedge_000007\n", "usemtl brick\n", "usemtl rebar\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  const std::string materials = test::read_text(folder_ / "pile.mtl");
  EXPECT_NE(materials.find("newmtl brick\nKd 0.4 0.1 0.1\n"), std::string::npos) << materials;
}

TEST_F(PileExport, PlyHasDistinctPositionsAndPieceNumbers) {
  const std::string text = test::read_text(write("ply"));
  EXPECT_NE(text.find("element vertex 12\n"), std::string::npos) << "4 corners of 3 pieces";
  EXPECT_NE(text.find("property int piece\n"), std::string::npos);
}

// A lost piece is left out, and fines have numbers far above: the order in the file is no number.
TEST_F(PileExport, PlyNumbersPiecesAsThePileDoes) {
  const std::int32_t numbers[] = {4, 7, 1 << 24};
  for (std::size_t i = 0; i < 3; ++i) model_.pieces[i].number = numbers[i];
  const std::string text = test::read_text(write("ply"));
  const std::size_t begin = text.find("end_header\n") + 11, size = 3 * 4 + 3 + 4;
  std::vector<std::int32_t> found;
  for (std::size_t v = 0; v < 12; v += 4) {
    std::int32_t number = 0;
    text.copy(reinterpret_cast<char*>(&number), 4, begin + v * size + 15);
    found.push_back(number);
  }
  EXPECT_EQ(found, (std::vector<std::int32_t>{4, 7, 1 << 24}));
}

// Names come from packs and mesh files of others.
TEST_F(PileExport, NamesLeaveNeitherTheirLineNorTheFolder) {
  model_.types[0].name = "../../../outside";
  model_.pieces[0].name = "wedge\nv 9 9 9";
  wedge_.surface_names[1] = "brick\nmap_Kd /etc/passwd";
  const std::string text = test::read_text(write("obj"));
  EXPECT_EQ(text.find("\nv 9 9 9"), std::string::npos);
  EXPECT_NE(text.find("o wedge\\x0av 9 9 9\n"), std::string::npos);
  EXPECT_EQ(test::read_text(folder_ / "pile.mtl").find("\nmap_Kd"), std::string::npos);
  write("sdf");
  EXPECT_FALSE(test::exists(folder_.path() + "/../outside.obj"));
  std::vector<std::string> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "sdf/meshes"))
    meshes.push_back(entry.path().filename().string());
  ASSERT_EQ(meshes.size(), 5u) << "two meshes, their convex parts and the materials";
  const std::string world = test::read_text(folder_ / "sdf/pile.sdf");
  int named = 0;
  for (const std::string& mesh : meshes) named += world.find("meshes/" + mesh + "<") != std::string::npos;
  EXPECT_EQ(named, 4) << "the world names its files";
  for (const std::string& mesh : meshes) EXPECT_TRUE(is_scene_file("meshes/" + mesh)) << mesh;
  EXPECT_TRUE(is_scene_file("pile.sdf"));
  for (const char* other : {"notes.txt", "meshes/photo.jpg", "mine/a.obj", "meshes/.obj2"}) EXPECT_FALSE(is_scene_file(other)) << other;
}

TEST_F(PileExport, OtherReadersFindTheSameVolume) {
  const std::string measure =
      "; q = p.astype(float)[t]; print('triangles', len(t), 'volume %.6f' % (np.einsum('ij,ij->i', "
      "q[:,0], np.cross(q[:,1], q[:,2])).sum() / 6))\"";
  const std::string with_meshio =
      "import meshio; m = meshio.read(path); t = m.cells_dict['triangle']; p = m.points";
  // meshio wants as many normals as positions, which OBJ does not.
  const std::string by_the_book =
      "r = [l.split() for l in open(path)]; "
      "p = np.array([[float(x) for x in w[1:]] for w in r if w[0] == 'v']); "
      "t = np.array([[int(x.split('/')[0]) - 1 for x in w[1:]] for w in r if w[0] == 'f'])";
  for (const std::string format : {"stl", "ply", "obj"}) {
    const std::string path = write(format);
    const auto result =
        test::run_command("/usr/bin/python3 -c \"import numpy as np; path = '" + path + "'; " +
                          (format == "obj" ? by_the_book : with_meshio) + measure);
    char expected[64];
    std::snprintf(expected, sizeof expected, "triangles 12 volume %.6f", expected_volume());
    EXPECT_NE(result.output.find(expected), std::string::npos)
        << format << ": " << expected << " is not in\n"
        << result.output;
  }
}

TEST_F(PileExport, AdmeshFindsThreeWholeParts) {
  const auto admesh = test::run_command("admesh " + write("stl"));
  EXPECT_EQ(admesh.exit_code, 0) << admesh.output;
  for (const char* row : {"Number of parts       :     3", "Degenerate facets     :     0",
                          "Total disconnected facets        :     0                   0"})
    EXPECT_NE(admesh.output.find(row), std::string::npos) << row << "\n" << admesh.output;
}

TEST_F(PileExport, GazebosParserLoadsTheWorld) {
#if __has_include(<sdf/sdf.hh>)
  write("sdf");
  sdf::Root root;
  const sdf::Errors errors = root.Load(folder_ / "sdf/pile.sdf");
  for (const sdf::Error& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_EQ(root.WorldCount(), 1u);
  const sdf::World& world = *root.WorldByIndex(0);
  EXPECT_EQ(world.ModelCount(), 4u) << "the ground and three pieces";
  EXPECT_NEAR(world.Gravity().Z(), -9.81, 1e-12);
  model_.gravity = 1.62;
  std::filesystem::create_directories(folder_ / "moon");
  export_pile(test::make_scene(model_), "sdf", folder_ / "moon");
  EXPECT_NE(test::read_text(folder_ / "moon/sdf/pile.sdf").find("<gravity>0 0 -1.62</gravity>"), std::string::npos);
  const sdf::Model* model = world.ModelByName("wedge_000007");
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->Static());
  EXPECT_NEAR(model->RawPose().Pos().Y(), -5, 1e-12);
  EXPECT_NEAR(model->RawPose().Rot().Yaw(), -1, 1e-9);
  for (const PileModel::Piece& piece : model_.pieces) {
    const auto read = world.ModelByName(piece.name)->RawPose().Rot();
    const Quat& q = piece.world_from_body.rotation;
    const double dot = read.W() * q.w + read.X() * q.x + read.Y() * q.y + read.Z() * q.z;
    EXPECT_NEAR(std::abs(dot), 1, 1e-9) << piece.name;
  }
  // Six numbers and no attribute: what every reader takes as roll, pitch and yaw.
  const std::string text = test::read_text(folder_ / "sdf/pile.sdf");
  EXPECT_EQ(text.find("rotation_format"), std::string::npos);
  EXPECT_NE(text.find("<pose>0 -5 0 0 0 -1</pose>"), std::string::npos) << text;
  const sdf::Mesh* mesh = model->LinkByIndex(0)->CollisionByIndex(0)->Geom()->MeshShape();
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->Uri(), "meshes/wedge_part_0.obj") << "the kernel's convex part";
  EXPECT_EQ(mesh->Scale().X(), 2.0);
  const TriangleMesh wedge = load_mesh(folder_ / "sdf/meshes/wedge.obj");
  EXPECT_NEAR(calc_volume_properties(wedge).volume, 2.0 * 0.5 / 6, 1e-6);
#else
  GTEST_SKIP() << "this release has no SDFormat";
#endif
}

// Of every file of every format, the SDF world's folder included; another pile gives others.
TEST_F(PileExport, GivesTheSameBytesTwiceAndOthersForAnotherPile) {
  for (const MeshFormat& mesh_format : mesh_formats()) {
    const std::string& format = mesh_format.name;
    const ScratchFolder a, b, c;
    export_pile(test::make_scene(model_), format, a.path());
    export_pile(test::make_scene(model_), format, b.path());
    PileModel moved = model_;
    moved.pieces[1].world_from_body.translation.z += 1e-3;
    export_pile(test::make_scene(moved), format, c.path());
    EXPECT_FALSE(test::read_tree(a.path()).empty());
    EXPECT_TRUE(test::read_tree(a.path()) == test::read_tree(b.path())) << format;
    EXPECT_FALSE(test::read_tree(a.path()) == test::read_tree(c.path())) << format;
  }
}

TEST_F(PileExport, NamesAPathThatIsTakenOrCannotBeWritten) {
  for (const MeshFormat& mesh_format : mesh_formats()) {
    const std::string& format = mesh_format.name;
    const std::string name = mesh_format.leaves.back();
    const ScratchFolder taken;
    std::filesystem::create_directories(taken / (name + "/inside"));
    // /proc is a folder that nobody may write to, not even root.
    for (const std::string& folder : {taken.path(), std::string("/proc")}) {
      try {
        export_pile(test::make_scene(model_), format, folder);
        ADD_FAILURE() << format << " was written into " << folder;
      } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find(folder + "/"), std::string::npos) << error.what();
      }
    }
    EXPECT_EQ(taken.names(), std::vector<std::string>{name}) << "something is left";
  }
}

TEST_F(PileExport, NamesTheFormatsThatItKnows) {
  try {
    write("fbx");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("stl, ply, obj, glb, sdf, mjcf, usd, urdf"), std::string::npos);
  }
}

}  // namespace pile_export_test
}  // namespace rubble
