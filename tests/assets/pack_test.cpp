// The bundled packs as files: closed, convex where they must be; and in the pack `concrete` visual and
// collision shapes close to each other. (How close they are in the others: tests/app/assets_test.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "tests/assets/obj_reader.h"
#include "tests/assets/probe.h"

namespace rubble::test {
namespace pack_test {

const std::string kFolder = std::string(RUBBLE_ASSETS_DIR) + "/concrete/";

const std::set<std::string> kSurfaces = {
    "concrete_cast",    "concrete_fracture", "brick",  "brick_fracture",  "cinder_block", "rebar",
    "steel_galvanised", "steel_rusty",       "timber", "timber_fracture", "drywall",      "drywall_core",
    "car_paint",        "glass",             "fabric", "rubber",          "plaster"};

TriangleMesh level(const std::string& name, int number) {
  return read_mesh(kFolder + name + ".lod" + std::to_string(number) + ".obj");
}

bool is_masonry(const std::string& name) {
  return name.find("brick") != std::string::npos || name.find("block") != std::string::npos;
}

struct GapLimits {  // how far surface and parts may be apart; unit: m
  double usual;     // for 95 of 100 points
  double worst;     // at chipped corners
};
GapLimits gap_limits(const std::string& name) {
  return is_masonry(name) ? GapLimits{0.004, 0.008} : GapLimits{0.010, 0.020};
}

class PackTest : public ::testing::TestWithParam<std::string> {};

// Every pack: what its files promise.
class FilesTest : public ::testing::TestWithParam<std::string> {
 protected:
  std::string folder() const { return std::string(RUBBLE_ASSETS_DIR) + "/" + GetParam() + "/"; }
  std::vector<std::string> names() const { return read_asset_names(folder() + "pack.lua"); }
  TriangleMesh read_level(const std::string& name, int number) const {
    return read_mesh(folder() + name + ".lod" + std::to_string(number) + ".obj");
  }
};

// How much volume a level may gain or lose, as a share: thin sheet and thin webs lose most.
double level_limit(const std::string& name, int level) {
  if (name == "car_bonnet") return level == 0 ? 1e-12 : level == 1 ? 0.25 : 0.40;  // 2 cm thick
  const bool thin = name.rfind("car_", 0) == 0 || name.rfind("guard_", 0) == 0 || name == "hollow_core";
  return level == 0 ? 1e-12 : level == 1 ? (thin ? 0.08 : 0.03) : (thin ? 0.30 : 0.12);
}

TEST_P(FilesTest, EveryLevelIsClosedAndFacesOut) {
  for (const std::string& name : names()) {
    const double volume = calc_volume_properties(read_level(name, 0)).volume;
    for (int i = 0; i < 3; ++i) {
      const TriangleMesh mesh = read_level(name, i);
      EXPECT_TRUE(is_closed(mesh)) << name << " level " << i;
      EXPECT_NEAR(calc_volume_properties(mesh).volume, volume,
                  level_limit(name, i) * volume)
          << name << " level " << i;
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      for (const Vec3f& n : mesh.normals) ASSERT_NEAR(norm(n), 1, 2e-3) << name;
    }
    EXPECT_GT(volume, 5e-5) << name;
  }
}

TEST_P(FilesTest, NormalsFaceAsTheirTriangles) {
  for (const std::string& name : names()) {
    const TriangleMesh mesh = read_level(name, 0);
    std::size_t askew = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
      const Vec3 face = normalized(cross(b - a, c - a));
      for (const auto v : t) askew += dot(face, Vec3(mesh.normals[v])) <= 0.5;
    }
    // None; but 10 um of the files' resolution can turn a sliver.
    EXPECT_LE(askew, mesh.triangles.size() / 1000) << name;
  }
}

TEST_P(FilesTest, LevelsHaveFewTriangles) {
  for (const std::string& name : names()) {
    const bool car = name.rfind("car_", 0) == 0;
    const std::size_t finest = read_level(name, 0).triangles.size();
    EXPECT_GE(finest, 300u) << name;
    EXPECT_LE(finest, car ? 18000u : 8000u) << name;
    EXPECT_LE(read_level(name, 1).triangles.size(), finest * 11 / 20) << name;
    EXPECT_LE(read_level(name, 2).triangles.size(), car ? 4500u : 1000u) << name;
  }
}

TEST_P(FilesTest, SurfacesAreKnown) {
  for (const std::string& name : names()) {
    const TriangleMesh mesh = read_level(name, 0);
    ASSERT_FALSE(mesh.surface_names.empty());
    for (const std::string& surface : mesh.surface_names)
      EXPECT_EQ(kSurfaces.count(surface), 1u) << name << ": " << surface;
  }
}

TEST_P(FilesTest, PartsAreConvexAndSolid) {
  for (const std::string& name : names()) {
    for (const Part& part : read_parts(folder() + name + ".parts.obj")) {
      EXPECT_GE(part.points.size(), 4u);
      EXPECT_LE(part.points.size(), 32u) << name;
      EXPECT_TRUE(is_closed(part.hull)) << name;
      double thinnest = 1e9;
      for (const HalfSpace& plane : planes_of(part)) {
        double depth = 0;
        for (const Vec3& p : part.points) {
          const double height = dot(plane.normal, p) - plane.offset;
          EXPECT_LE(height, 1e-4) << name << ": a corner above a face";
          depth = std::max(depth, -height);
        }
        thinnest = std::min(thinnest, depth);
      }
      EXPECT_GE(thinnest, 0.01) << name;
      for (std::size_t i = 0; i < part.points.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          EXPECT_GE(distance(part.points[i], part.points[k]), 1e-3) << name << ": corners too close";
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Packs, FilesTest,
                         ::testing::Values("concrete", "residential", "parking", "bridge", "victims"),
                         [](const auto& test) { return test.param; });

TEST_P(PackTest, PartsContainTheSurface) {
  const TriangleMesh mesh = level(GetParam(), 0);
  std::vector<std::vector<HalfSpace>> planes;
  for (const Part& part : read_parts(kFolder + GetParam() + ".parts.obj")) {
    planes.push_back(planes_of(part));
  }
  double worst = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool bar = mesh.surface_names[mesh.surfaces[t]] == "rebar";
    for (const auto v : mesh.triangles[t]) {
      double height = 1e9;
      for (const auto& part : planes)
        height = std::min(height, height_above(part, Vec3(mesh.positions[v])));
      // Bars broken off shorter than 5 cm have no part of their own.
      if (bar && height < 0.055) height = std::min(height, 0.0);
      worst = std::max(worst, height);
    }
  }
  std::printf("[ outside  ] %s: %.1f mm\n", GetParam().c_str(), 1000 * worst);
  EXPECT_LE(worst, 0.006);
}

TEST_P(PackTest, SurfaceIsCloseToTheParts) {
  const TriangleMesh mesh = level(GetParam(), 0);
  const std::vector<Part> parts = read_parts(kFolder + GetParam() + ".parts.obj");
  const Vec3 size = mesh.bounds().max - mesh.bounds().min;
  const double spacing = is_masonry(GetParam()) ? 0.015 : (norm(size) < 1.6 ? 0.04 : 0.09);
  const std::vector<Vec3> points = exposed_points(parts, spacing);
  ASSERT_GE(points.size(), 8u);
  std::vector<double> gaps;
  for (const Vec3& p : points) gaps.push_back(distance_to_mesh(p, mesh));
  std::sort(gaps.begin(), gaps.end());
  const double usual = gaps[gaps.size() * 95 / 100], worst = gaps.back();
  std::printf("[ gaps     ] %s: median %.1f mm, 95 %% %.1f mm, largest %.1f mm\n",
              GetParam().c_str(), 1000 * gaps[gaps.size() / 2], 1000 * usual, 1000 * worst);
  EXPECT_LE(usual, gap_limits(GetParam()).usual);
  EXPECT_LE(worst, gap_limits(GetParam()).worst);
}

TEST_P(PackTest, VolumesAgree) {
  const double volume = calc_volume_properties(level(GetParam(), 0)).volume;
  const double parts = calc_union_volume(read_parts(kFolder + GetParam() + ".parts.obj"));
  std::printf("[ volume   ] %s: %.5f m3, parts %.5f\n", GetParam().c_str(), volume, parts);
  EXPECT_NEAR(volume / parts, 1, 0.03);
}

// Without the plank, whose round bores flat parts can follow only roughly.
std::vector<std::string> followed_closely() {
  std::vector<std::string> names = read_asset_names(kFolder + "pack.lua");
  names.erase(std::remove(names.begin(), names.end(), "hollow_core"), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Concrete, PackTest, ::testing::ValuesIn(followed_closely()),
                         [](const auto& test) { return test.param; });

TEST(Pack, NamesAreUniqueAndEnough) {
  std::size_t count = 0;
  std::set<std::string> all;
  for (const char* pack : {"concrete", "residential", "parking", "bridge", "victims"}) {
    for (const std::string& name :
         read_asset_names(std::string(RUBBLE_ASSETS_DIR) + "/" + pack + "/pack.lua")) {
      all.insert(name);
      ++count;
    }
  }
  EXPECT_GE(count, 60u);
  EXPECT_EQ(all.size(), count) << "packs are to be used together";
}

TEST(Pack, IsSmall) {
  for (const char* pack : {"concrete", "residential", "parking", "bridge", "victims"}) {
    std::uintmax_t bytes = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(RUBBLE_ASSETS_DIR) + "/" + pack))
      bytes += entry.file_size();
    EXPECT_LT(bytes, 20u << 20) << pack;
    EXPECT_GT(bytes, 1u << 20) << pack;
  }
}

}  // namespace pack_test
}  // namespace rubble::test
