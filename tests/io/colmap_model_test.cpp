// COLMAP's models, as COLMAP 3.8 wrote them (tests/io/colmap: made by hand, then run through its
// model_converter to binary and back to text) and as they look when something is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/base/atomic_file.h"
#include "io/datasets/colmap_model.h"
#include "io/mesh_formats/ply_reader.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace colmap_model_test {

const std::string kWritten = std::string(RUBBLE_SOURCE_DIR) + "/tests/io/colmap/";

void expect_as_made(ColmapModel model) {
  ASSERT_EQ(model.cameras.size(), 2u);
  // COLMAP writes its binary lists in the order of a hash table.
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(model.cameras.begin(), model.cameras.end(), by_id);
  std::sort(model.images.begin(), model.images.end(), by_id);
  std::sort(model.points.begin(), model.points.end(), by_id);
  EXPECT_EQ(model.cameras[0].model, "PINHOLE");
  EXPECT_EQ(model.cameras[0].params, (std::vector<double>{500, 510, 320.5, 240.5}));
  EXPECT_EQ(model.cameras[1].id, 7u);
  EXPECT_EQ(model.cameras[1].model, "OPENCV");
  EXPECT_EQ(model.cameras[1].width, 320u);
  ASSERT_EQ(model.cameras[1].params.size(), 8u);
  EXPECT_EQ(model.cameras[1].params[7], -0.002);
  ASSERT_EQ(model.images.size(), 3u);
  EXPECT_EQ(model.images[0].name, "000000.png");
  ASSERT_EQ(model.images[0].features.size(), 3u);
  EXPECT_EQ(model.images[0].features[0].y, 200.25);
  EXPECT_EQ(model.images[0].features[1].point, kNoColmapPoint);
  EXPECT_EQ(model.images[0].features[2].point, 900u);
  EXPECT_EQ(model.images[1].camera, 7u);
  EXPECT_EQ(model.images[1].name, "sub/000001.png");
  EXPECT_NEAR(model.images[1].camera_from_world.rotation.y, 0.6, 1e-15);
  EXPECT_EQ(model.images[2].id, 9u);
  EXPECT_EQ(model.images[2].camera_from_world.translation, (Vec3{1e-3, -2e5, 0.125}));
  EXPECT_TRUE(model.images[2].features.empty());
  ASSERT_EQ(model.points.size(), 2u);
  EXPECT_EQ(model.points[0].id, 3u);
  EXPECT_EQ(model.points[0].rgb[0], 255);
  EXPECT_EQ(model.points[1].position, (Vec3{1.5, 2.5, -3.5}));
  EXPECT_EQ(model.points[1].error, 1.25);
  ASSERT_EQ(model.points[1].track.size(), 2u);
  EXPECT_EQ(model.points[1].track[0].image, 1u);
  EXPECT_EQ(model.points[1].track[0].feature, 2u);
}

TEST(ColmapModel, ReadsWhatColmapWroteAsText) {
  expect_as_made(load_colmap_model(kWritten + "text"));
}

TEST(ColmapModel, ReadsWhatColmapWroteAsBinary) {
  expect_as_made(load_colmap_model(kWritten + "binary"));
}

TEST(ColmapModel, KnowsTheNumbersOfCamerasThatColmapHas) {
  EXPECT_EQ(colmap_model_name(5), "OPENCV_FISHEYE");
  EXPECT_EQ(colmap_parameter_count(colmap_model_name(10)), 12u);
  EXPECT_EQ(colmap_model_name(11), "");
  EXPECT_EQ(colmap_parameter_count("PINHOL"), 0u);
}

// The message of an InputError that `work` throws; empty when it throws none.
template <typename Work>
std::string error_of(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string load_error(const std::string& folder) {
  return error_of([&] { load_colmap_model(folder); });
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

struct Damage {
  const char *file, *from, *to;  // replaces the first `from`
  const char* message;
};

TEST(ColmapModel, NamesFileAndLineOfWhatIsWrongInAText) {
  const Damage kDamages[] = {
      {"cameras.txt", "PINHOLE", "PINHOL", "cameras.txt:4: unknown camera model"},
      {"cameras.txt", " 240.5", "", "cameras.txt:4: the line ends early: expected PARAMS"},
      {"cameras.txt", "320.5", "nan", "cameras.txt:4: not a finite number"},
      {"cameras.txt", "240.5", "240.5 9", "cameras.txt:4: too many numbers"},
      {"images.txt", "1 1 0 0 0", "1 0 0 0 0", "images.txt:5: not a rotation"},
      {"images.txt", "2 0.8", "x 0.8", "images.txt:7: not a number"},
      {"images.txt", "3 7 sub", "3 8 sub", "images.txt:7: no such camera"},
      {"images.txt", "9 0.59", "2 0.59", "images.txt:9: the id repeats"},
      {"images.txt", " 000002.png", "", "images.txt:9: the line ends early: expected NAME"},
      {"images.txt", "10 20 -1", "10 20 77", "images.txt:5: sees a point that is not there"},
      {"points3D.txt", "-3.5", "inf", "points3D.txt:5: not a finite number"},
      {"points3D.txt", "255", "256", "points3D.txt:4: not a number"},
      {"points3D.txt", "1 0 2 0", "1 0 2", "points3D.txt:4: the line ends early"},
      {"points3D.txt", "1 0 2 0", "1 1 2 0", "points3D.txt:4: the track does not agree"},
      {"points3D.txt", "900 1.5", "3 1.5", "points3D.txt:5: the id repeats"},
  };
  for (const Damage& damage : kDamages) {
    const test::ScratchFolder folder;
    for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) {
      std::string text = read_whole_file(kWritten + "text/" + name);
      if (std::string(name) == damage.file) {
        const std::size_t at = text.find(damage.from, text.find_last_of('#'));
        ASSERT_NE(at, std::string::npos) << damage.message;
        text.replace(at, std::string(damage.from).size(), damage.to);
      }
      write(folder / name, text);
    }
    const std::string message = load_error(folder.path());
    EXPECT_NE(message.find(damage.message), std::string::npos) << message << "\n" << damage.message;
  }
}

// Every length of every file but the whole one: none may be taken for a model, none may crash.
TEST(ColmapModel, RefusesABinaryFileThatIsCutAnywhere) {
  for (const char* cut : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const test::ScratchFolder folder;
    for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"})
      std::filesystem::copy_file(kWritten + "binary/" + name, folder / name);
    ASSERT_EQ(load_error(folder.path()), "");
    const std::string whole = read_whole_file(folder / cut);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      write(folder / cut, whole.substr(0, size));
      const std::string message = load_error(folder.path());
      EXPECT_NE(message.find(std::string(cut) + ": byte"), std::string::npos) << size << message;
      EXPECT_NE(message.find("the file ends early"), std::string::npos) << size << message;
    }
    write(folder / cut, whole + "x");
    EXPECT_NE(load_error(folder.path()).find("more than was announced"), std::string::npos);
  }
}

TEST(ColmapModel, SaysWhatIsMissing) {
  const test::ScratchFolder folder;
  EXPECT_NE(load_error(folder.path()).find("found none of them"), std::string::npos);
  write(folder / "cameras.bin", "");
  EXPECT_NE(load_error(folder.path()).find("found cameras.bin"), std::string::npos);
}

const char* const kPly =
    "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 255\n1 0 0 0\n1 1 0 0\n0 1 0.5 0\n4 0 1 2 3\n";

TEST(PlyReader, TakesMeshesAndFansOutPolygons) {
  const test::ScratchFolder folder;
  write(folder / "a.ply", kPly);
  const PlyMesh mesh = load_ply(folder / "a.ply");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[3], (Vec3{0, 1, 0.5}));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

// The header gives the order.
TEST(PlyReader, TakesFacesBeforeTheirVertices) {
  const test::ScratchFolder folder;
  const std::string header =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n";
  write(folder / "a.ply", header + "4 0 1 2 3\n" + vertices);
  const PlyMesh mesh = load_ply(folder / "a.ply");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[3], (Vec3{0, 1, 0.5}));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  write(folder / "a.ply", header + "3 0 1 4\n" + vertices);
  EXPECT_NE(error_of([&] { load_ply(folder / "a.ply"); }).find("a.ply:10: no such corner: expected 0 to 3"), std::string::npos);
}

TEST(PlyReader, NamesTheLineOfWhatIsWrong) {
  const test::ScratchFolder folder;
  const auto damaged = [&](const std::string& from, const std::string& to) {
    std::string text = kPly;
    text.replace(text.find(from), from.size(), to);
    write(folder / "a.ply", text);
    return error_of([&] { load_ply(folder / "a.ply"); });
  };
  EXPECT_NE(damaged("4 0 1 2 3", "4 0 1 2 4").find("a.ply:16: no such corner"), std::string::npos);
  EXPECT_NE(damaged("0 1 0.5 0", "0 1 inf 0").find("a.ply:15: not finite"), std::string::npos);
  EXPECT_NE(damaged("float z", "float w").find("a vertex without a place"), std::string::npos);
  EXPECT_NE(damaged("ascii", "binary_middle_endian").find("a.ply:2: unknown format"),
            std::string::npos);
  EXPECT_NE(damaged("4 0 1 2 3\n", "").find("the file ends early"), std::string::npos);
  EXPECT_NE(damaged("vertex 4", "vertex -4").find("a.ply:4: no count of vertex: expected 0 or more, found -4"), std::string::npos);
  EXPECT_NE(damaged("element vertex", "element other").find("holds no vertex"), std::string::npos);
}

// 200 bytes that took all memory, or for ever.
TEST(PlyReader, BelievesNoNumberThatTheFileCannotHold) {
  const test::ScratchFolder folder;
  const std::string vertex =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const auto error_with = [&](const std::string& format, const std::string& elements,
                              const std::string& data) {
    write(folder / "a.ply", "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + data);
    return error_of([&] { load_ply(folder / "a.ply"); });
  };
  const std::string huge = "18446744073709551615\n";
  EXPECT_EQ(error_with("ascii", "element foo " + huge + vertex, "0 0 0\n"), "");
  EXPECT_NE(error_with("ascii", vertex + "element foo " + huge + "property int a\n", "0 0 0\n1\n")
                .find("the file ends early: expected 18446744073709551615 of foo"),
            std::string::npos);
  EXPECT_NE(error_with("binary_little_endian", "element vertex " + huge + vertex.substr(17),
                       std::string(24, '\0'))
                .find("the file ends early"),
            std::string::npos);
  const std::string list = vertex + "element foo 1\nproperty list int int a\n";
  EXPECT_NE(error_with("binary_little_endian", list, std::string(12, '\0') + "\xff\xff\xff\xff")
                .find("no length of a list"),
            std::string::npos);
  EXPECT_NE(error_with("binary_little_endian", list, std::string(12, '\0') + "\x7f\xff\xff\x7f")
                .find("no length of a list"),
            std::string::npos);
}

}  // namespace colmap_model_test
}  // namespace rubble
