// The renderer's parts that need no context: meshes, shaders' text, noise, exposure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "render/geometry/mesh_refine.h"
#include "render/geometry/point_cells.h"
#include "render/geometry/prepared_mesh.h"
#include "render/gl/gl_context.h"
#include "render/gl/shader.h"
#include "render/lighting/exposure.h"
#include "render/materials/textures.h"
#include "render/materials/tile_noise.h"
#include "render/passes/antialias.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace parts_test {

TEST(PointCells, FindsAllPointsOfTheCellsAboutAPlaceInOrder) {
  const float cell = 0.25f;
  RandomStream random(3, "point_cells");
  std::vector<PointCells::Point> points;
  // Thick about the origin, and a few far away from it.
  for (std::uint32_t i = 0; i < 600; ++i) {
    const float size = i % 6 == 0 ? 40.0f : 1.5f;
    const auto along = [&] { return size * float(random.uniform(-1, 1)); };
    const float x = along(), y = along(), z = along();
    points.push_back({{x, y, z}, 1000 + i});
  }
  const PointCells grid(cell, points);
  const auto cells = [&](const Vec3f& p) {
    return std::array{int(std::floor(p.z / cell)), int(std::floor(p.y / cell)), int(std::floor(p.x / cell))};
  };
  std::size_t most = 0;
  for (const int reach : {0, 1, 2, 7, 100})
    for (std::size_t n = 0; n < points.size(); n += 7) {
      const Vec3f place = points[n].position + Vec3f{0.1f, -0.2f, 0.3f};
      const auto middle = cells(place);
      std::vector<std::pair<std::array<int, 3>, std::uint32_t>> expected;
      for (const PointCells::Point& p : points) {
        const auto c = cells(p.position);
        bool near = true;
        for (std::size_t k = 0; k < 3; ++k) near = near && std::abs(c[k] - middle[k]) <= reach;
        if (near) expected.emplace_back(c, p.index);
      }
      std::sort(expected.begin(), expected.end());
      std::vector<std::uint32_t> sorted, found;
      for (const auto& [c, index] : expected) sorted.push_back(index);
      grid.near(place, reach, [&](std::uint32_t index) { found.push_back(index); });
      ASSERT_EQ(found, sorted) << "reach " << reach << ", point " << n;
      most = std::max(most, found.size());
    }
  EXPECT_GT(most, 400u);
}

TEST(RefineMesh, CutsLongEdgesAndKeepsTheSurfaceClosed) {
  const TriangleMesh slab = make_box({3, 2, 0.2});
  const TriangleMesh fine = refine_mesh(slab, 0.3f);
  EXPECT_TRUE(is_closed(fine));
  EXPECT_NEAR(calc_volume_properties(fine).volume, 1.2, 1e-5);
  float longest = 0;
  for (const auto& t : fine.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, distance(fine.positions[t[k]], fine.positions[t[(k + 1) % 3]]));
  EXPECT_LE(longest, 0.3f);
  EXPECT_GT(fine.triangles.size(), slab.triangles.size());
  EXPECT_EQ(fine.normals.size(), fine.positions.size());
}

TEST(RefineMesh, GivesABoxOneNormalASide) {
  const TriangleMesh box = refine_mesh(make_box({1, 1, 1}), 10);
  EXPECT_EQ(box.positions.size(), 24u);
  for (const Vec3f& n : box.normals)
    EXPECT_NEAR(std::max({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)}), 1, 1e-6);
}

// Light is baked along them: one of no length has no direction. The first triangle gets a grid of nodes, the
// second is cut.
TEST(PrepareMesh, GivesEveryNodeOfLightADirectionWhereNormalsAreOpposed) {
  for (const float side : {0.19f, 0.6f}) {
    TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {side, 0, 0}, {0.5f * side, 0.3f * side, 0}};
    sheet.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
    sheet.triangles = {{0, 1, 2}}, sheet.surfaces = {0}, sheet.surface_names = {"plaster"};
    SceneMesh mesh;
    mesh.levels = {sheet};
    const PreparedMesh prepared = prepare_mesh(mesh);
    EXPECT_GT(prepared.light_nodes.size(), 3u);
    for (const LightNode& node : prepared.light_nodes) EXPECT_NEAR(norm(node.normal), 1, 1e-5);
    for (const BakePoint& point : prepared.bake_points) EXPECT_NEAR(norm(point.normal), 1, 1e-5);
  }
}

TEST(PrepareMesh, ClustersCoverEveryTriangleOnce) {
  SceneMesh mesh;
  mesh.levels = {make_chunk(1, "brick", "brick_fracture"), make_box({1, 1, 1})};
  const PreparedMesh prepared = prepare_mesh(mesh);
  ASSERT_EQ(prepared.levels.size(), 2u);
  std::uint32_t next = 0;
  for (const PreparedLevel& level : prepared.levels) {
    EXPECT_EQ(level.first_triangle, next);
    for (std::uint32_t c = 0; c < level.cluster_count; ++c) {
      const Cluster& cluster = prepared.clusters[level.first_cluster + c];
      EXPECT_EQ(cluster.first_triangle, next);
      next += cluster.triangle_count;
      for (std::uint32_t t = cluster.first_triangle; t < next; ++t)
        for (std::uint32_t v : prepared.triangles[t].vertices)
          EXPECT_LE(distance(prepared.vertices[v].position, cluster.centre),
                    cluster.radius * 1.001f);
    }
  }
  EXPECT_EQ(next, prepared.triangles.size());
  ASSERT_GE(prepared.light_nodes.size(), prepared.vertices.size());
  for (const LightNode& node : prepared.light_nodes) {
    float sum = 0;
    for (float w : node.weights) sum += w;
    EXPECT_NEAR(sum, 1, 1e-4);
  }
}

// What is linear over a face comes back from the nodes about any place of it, to rounding.
TEST(LightNodes, AreInterpolatedExactlyOverAFace) {
  SceneMesh mesh;
  mesh.levels = {make_box({2, 1, 0.5})};
  const PreparedMesh prepared = prepare_mesh(mesh);
  ASSERT_GT(prepared.triangles[0].light_steps, 1u);
  for (std::uint32_t t = 0; t < prepared.triangles.size(); ++t) {
    for (int k = 0; k < 200; ++k) {
      const float u = float(k % 20) / 19, v = (1 - u) * float(k / 20) / 9;
      const auto& corners = prepared.triangles[t].vertices;
      const Vec3f expected = prepared.vertices[corners[0]].position * (1 - u - v) +
                             prepared.vertices[corners[1]].position * u + prepared.vertices[corners[2]].position * v;
      const LightNodes nodes = find_light_nodes(prepared, t, u, v);
      Vec3f found;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GE(nodes.weight[i], -1e-5f);
        found += prepared.light_nodes[nodes.node[i]].position * nodes.weight[i];
      }
      EXPECT_LT(distance(found, expected), 1e-5f);
    }
  }
}

// Along a face light may have no steps: neighbouring nodes take it from nearly the same points.
TEST(LightNodes, GoOverSmoothlyFromPointToPoint) {
  SceneMesh mesh;
  mesh.levels = {make_sphere(24)};
  const PreparedMesh prepared = prepare_mesh(mesh);
  const auto height = [&](const LightNode& node) {
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += node.weights[k] * prepared.bake_points[node.points[k]].position.z;
    return sum;
  };
  for (const PreparedTriangle& t : prepared.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const LightNode& a = prepared.light_nodes[t.vertices[k]];
      const LightNode& b = prepared.light_nodes[t.vertices[(k + 1) % 3]];
      EXPECT_LT(std::fabs(height(a) - height(b)), 1.6f * distance(a.position, b.position));
    }
}

TEST(Shader, ExpandsIncludesWithLineNumbers) {
  const ExpandedShader shader = expand_shader("resolve.frag.glsl", {{"LIGHT_TYPE", "2"}});
  EXPECT_EQ(shader.text.find("#version 450 core\n#define LIGHT_TYPE 2\n#line 1 0\n"), 0u);
  ASSERT_GT(shader.files.size(), 2u);
  EXPECT_EQ(shader.files[1], "frame.glsl");
  EXPECT_NE(shader.text.find("#line 1 1\n"), std::string::npos);
  EXPECT_EQ(shader.text.find("#include"), std::string::npos);
  EXPECT_THROW(expand_shader("missing.glsl", {}), RunError);
}

TEST(Shader, NamesFilesInBothKindsOfLogs) {
  const std::vector<std::string> files = {"a.glsl", "b.glsl"};
  EXPECT_EQ(name_files_in_log("1:12(5): error: what\n", files), "b.glsl:12(5): error: what\n");
  EXPECT_EQ(name_files_in_log("0(7) : error C1: what\n", files), "a.glsl:7 : error C1: what\n");
  EXPECT_EQ(name_files_in_log("9:1: other\nplain\n", files), "9:1: other\nplain\n");
}

TEST(Shader, ACompileErrorNamesItsFileAndLine) {
  const GlContext context;
  try {
    // A variant that spoils an included file.
    make_program(context.gl(), "fullscreen.vert.glsl", "resolve.frag.glsl",
                 {{"unpackHalf2x16", "no_such_function"}});
    FAIL() << "compiled";
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("packing.glsl:"), std::string::npos) << text;
  }
}

TEST(TileNoise, RepeatsWithoutASeam) {
  for (int i = 0; i < 50; ++i) {
    const float y = float(i) / 50;
    EXPECT_NEAR(tile_fractal(0, y, 6, 4, 0.5f, 3), tile_fractal(1, y, 6, 4, 0.5f, 3), 1e-5);
    EXPECT_NEAR(tile_cells(0, y, 7, 4).nearest, tile_cells(1, y, 7, 4).nearest, 1e-4);
  }
}

TEST(Textures, DifferAndDoNotDependOnThreads) {
  const auto one = make_patterns(32, 1), two = make_patterns(32, 2);
  ASSERT_EQ(one.size(), std::size_t(kPatternCount));
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].texels, two[i].texels);
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(one[i].texels, one[k].texels);
  }
}

MeteredImage metered(double kcd_per_m2) {
  return {8, 8, std::vector<float>(64, float(std::log2(kcd_per_m2)))};
}

TEST(DisplayExposure, BringsTheMeteredMeanToTheKeyWhateverItIs) {
  for (const double luminance : {1e-6, 1e-4, 0.3, 3.0, 400.0})
    EXPECT_NEAR(luminance * double(find_exposure({0.18, 0, 1}, metered(luminance))), 0.18, 1e-3)
        << luminance;
  EXPECT_EQ(find_exposure({0.18, 0.02, 1}, metered(3)), 0.02f);
  MeteredImage half = metered(3);
  for (std::size_t i = 0; i < 32; ++i) half.stops[i] = -2000;  // no lens there
  EXPECT_EQ(find_exposure({}, half), find_exposure({}, metered(3)));
  half.stops.assign(64, -2000);
  EXPECT_EQ(find_exposure({}, half), 0.1f);
}

TEST(DisplayExposure, ShowsDuskDarkerThanNoon) {
  const auto shown = [](double kcd_per_m2) {
    return kcd_per_m2 * double(find_exposure({0.18, 0, 0.35}, metered(kcd_per_m2)));
  };
  EXPECT_NEAR(shown(5), 0.18, 0.02);
  EXPECT_NEAR(shown(0.01) / shown(5), 0.58, 0.08);  // key(10) / key(4000) of the formula
  EXPECT_NEAR(shown(1e-5) / shown(5), 0.35, 0.05);
}

// A bright half-plane above a gently sloping line: the exact cover of a pixel is known.
struct Slope {
  static constexpr int kSize = 64;
  std::vector<std::uint8_t> rgba = std::vector<std::uint8_t>(kSize * kSize * 4);
  std::vector<float> depth = std::vector<float>(kSize * kSize);
  std::vector<double> cover = std::vector<double>(kSize * kSize);

  explicit Slope(bool depth_too) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const std::size_t i = std::size_t(y * kSize + x);
        const double below = y - (30.2 + 0.13 * x);  // of the pixel's centre under the line
        cover[i] = std::clamp(0.5 - below, 0.0, 1.0);
        depth[i] = depth_too && below < 0 ? 0.02f : 0.01f;
        for (std::size_t c = 0; c < 4; ++c) rgba[i * 4 + c] = below < 0 ? 200 : 40;
      }
    }
  }
  double error(const std::vector<std::uint8_t>& image, std::size_t step) const {
    double sum = 0;
    for (std::size_t i = 0; i < cover.size(); ++i)
      sum += std::fabs(40 + 160 * cover[i] - image[i * step]);
    return sum;
  }
};

TEST(SmoothEdges, BringsStairsNearTheExactCover) {
  const Slope slope(true);
  std::vector<std::uint8_t> rgb, rgb2;
  ThreadPool one(1), two(2);
  smooth_edges(slope.rgba, slope.depth, Slope::kSize, Slope::kSize, one, rgb);
  EXPECT_LT(slope.error(rgb, 3), 0.6 * slope.error(slope.rgba, 4));
  smooth_edges(slope.rgba, slope.depth, Slope::kSize, Slope::kSize, two, rgb2);
  EXPECT_EQ(rgb, rgb2);
}

TEST(SmoothEdges, LeavesTexturesAlone) {
  const Slope slope(false);  // the same picture on a plane of one depth
  std::vector<std::uint8_t> rgb;
  ThreadPool one(1);
  smooth_edges(slope.rgba, slope.depth, Slope::kSize, Slope::kSize, one, rgb);
  EXPECT_EQ(slope.error(rgb, 3), slope.error(slope.rgba, 4));
}

}  // namespace parts_test
}  // namespace rubble::testing
