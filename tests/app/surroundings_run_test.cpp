// Surroundings in runs: in pictures, depth, labels, exports and files, lit by their lamps, and nothing of them where a
// mission has none.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "app/eval/scores/saved_surface.h"
#include "app/pipeline/stages.h"
#include "app/scene/build_scene.h"
#include "app/surroundings/pile_surroundings.h"
#include "io/image/image_file.h"
#include "kernel/base/portable_math.h"
#include "kernel/queries/queries.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"
#include "tests/render/cached_options.h"

namespace rubble::testing {
namespace surroundings_run_test {

namespace fs = std::filesystem;

const char* const kMission = R"(
return rubble.mission {
  seed = 5,
  surroundings = { type = "street", reach = 40, storeys = { 2, 3 } },
  light = { type = "sun", sky = "city_night" },
  lamp = { on = false },
  pile = { layers = 1, pieces_per_layer = 6, spawn_bounds = { 1.5, 1.5, 1 }, spawn_position = { 0, 0, 1.5 },
           mix = { { asset = "brick", scale = { 1, 2 } } } },
  camera = { width = 96, height = 72, channels = { "label", "instance" } },
  outputs = { frames = true, stl = true, meshes = { "glb" }, rawlog = false, simplemap = false, bag = false },
  trajectory = { rate_hz = 5, waypoints = { { t = 0, position = { -1, 3, 1.7 }, look_at = { 0, -8, 1 } },
                                            { t = 0.2, position = { -1, 3.1, 1.7 }, look_at = { 0, -8, 1 } } } },
})";

struct Settled {
  ResolvedMission mission;
  PileState pile;
};

// Made once for all tests.
const Settled& settled_here() {
  static const Settled once = [] {
    const ScratchFolder folder;
    write_file(folder / "m.lua", kMission);
    RunRequest request;
    request.mission = folder / "m.lua", request.options.quiet = true, request.options.threads = 1;
    RunContext context(request.options);
    Settled settled{resolve_mission(request, RunKind::settle, context), {}};
    settled.pile = settle_in_memory(settled.mission, context, [] { return true; }).state;
    return settled;
  }();
  return once;
}

struct Eye {
  Pose pose;
  Intrinsics k;
};

Eye towards_the_street() {
  Eye eye;
  eye.k.width = 240, eye.k.height = 180, eye.k.fx = eye.k.fy = 120, eye.k.cx = 119.5, eye.k.cy = 89.5;
  eye.pose = {portable::quat_from_rpy(0, 0.12, -portable::kPi / 2), {0, 3, 2.5}};
  return eye;
}

LinearFrame render(const Scene& scene, const Eye& eye, bool bake = false) {
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = bake, options.bake_rays = 16;
  Renderer renderer(device, scene, options);
  return renderer.render_linear(eye.pose, eye.k);
}

// The street by night; drawn once for all tests.
const LinearFrame& lit_street() {
  static const LinearFrame once = render(
      build_scene(settled_here().mission.scenario, settled_here().mission.assets, settled_here().pile), towards_the_street());
  return once;
}

// What is near the pile, of which light is found sooner.
void keep_near(Scene& scene, double reach) {
  std::vector<std::shared_ptr<const SceneMesh>> meshes;
  std::vector<SceneInstance> instances;
  std::map<std::uint32_t, std::uint32_t> kept;
  for (SceneInstance instance : scene.instances) {
    if (norm(instance.world_from_body.translation) > reach) continue;
    const auto [at, is_new] = kept.emplace(instance.mesh, std::uint32_t(meshes.size()));
    if (is_new) meshes.push_back(scene.meshes[instance.mesh]);
    instance.mesh = at->second;
    instances.push_back(instance);
  }
  scene.meshes = std::move(meshes), scene.instances = std::move(instances);
}

// The mission's pile with its street and without.
class SettledStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_file(*folder_ / "m.lua", kMission);
    const std::string settle = "settle " + (*folder_ / "m.lua") + " --quiet ";
    const Outcome run = run_rubble(settle + "--out " + (*folder_ / "out"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(run_rubble(settle + "--set surroundings.type=none --out " + (*folder_ / "bare")).exit_code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static inline ScratchFolder* folder_ = nullptr;
  const ScratchFolder& folder = *folder_;
  const std::string out = folder / "out", bare = folder / "bare";
};

TEST_F(SettledStreet, IsInEveryProductAndLeavesThePileAlone) {
  EXPECT_EQ(read_file(out + "/pile.bin"), read_file(bare + "/pile.bin"));
  EXPECT_EQ(read_state_hash(out), read_state_hash(bare));
  EXPECT_IN("building_12", read_file(out + "/pile.glb"));
  EXPECT_EQ(read_file(bare + "/pile.glb").find("building_12"), std::string::npos);
  EXPECT_GT(fs::file_size(out + "/pile.stl"), fs::file_size(bare + "/pile.stl") + 5'000'000);
  EXPECT_EQ(run_rubble("export " + out + " --format ply --out " + (folder / "again")).exit_code, 0);
  EXPECT_GT(fs::file_size(folder / "again/pile.ply"), 2'000'000u);
  // Maps are scored against them, too: a ray at eye height meets a front.
  const SavedSurface scored(out, {});
  const auto hit = scored.geometry.queries.cast_ray({0, 3, 3}, {0, -1, 0}, 100);
  ASSERT_TRUE(hit.has_value());
  EXPECT_GE(hit->piece, kFirstSurrounding);
  EXPECT_FALSE(SavedSurface(bare, {}).geometry.queries.cast_ray({0, 3, 3}, {0, -1, 0}, 100).has_value());
}

// Of what a pixel's depth says, against a ray through the middle of the pixel in double precision.
TEST(SurroundingsRun, DepthAndLabelsAreThoseOfTheTrueMeshes) {
  const Settled& settled = settled_here();
  const Scenario& scenario = settled.mission.scenario;
  const PileQueries queries(settled.pile, settled.mission.assets.finest_meshes());
  const Scene scene = build_scene(scenario, settled.mission.assets, settled.pile);
  const Eye eye = towards_the_street();
  const LinearFrame& frame = lit_street();
  const auto& things = settled.pile.surroundings->things;
  int seen = 0, apart = 0;
  std::set<int> kinds;
  for (int v = 0; v < eye.k.height; v += 2)
    for (int u = 0; u < eye.k.width; u += 2) {
      const Vec3 along =
          (eye.pose * camera_from_optical).rotation.rotate({(u - eye.k.cx) / eye.k.fx, (v - eye.k.cy) / eye.k.fy, 1});
      const auto hit = queries.cast_ray(eye.pose.translation, along, 500);
      if (!hit || hit->piece < kFirstSurrounding) continue;
      const SurroundingKind kind = things[std::size_t(hit->piece - kFirstSurrounding)].kind;
      if (kind == SurroundingKind::tree || kind == SurroundingKind::soil || kind == SurroundingKind::fence) continue;
      const auto i = std::size_t(v) * std::size_t(eye.k.width) + std::size_t(u);
      if (frame.instance[i] >= std::uint32_t(kFirstSurrounding) && frame.instance[i] < kNoInstance) {
        const SurroundingKind drawn = things[frame.instance[i] - std::uint32_t(kFirstSurrounding)].kind;
        if (drawn == SurroundingKind::tree || drawn == SurroundingKind::soil) continue;  // leaves that queries leave out
      }
      ++seen, kinds.insert(int(kind));
      const double expected = hit->distance / norm(along);
      apart += std::fabs(double(frame.depth[i]) - expected) > 1e-3 + 1e-4 * expected;
    }
  EXPECT_GT(seen, 2000);
  EXPECT_GE(kinds.size(), 4u);
  EXPECT_LE(apart, seen / 100) << "of " << seen;
  const std::vector<std::string> names = ClassLabels(scenario, settled.mission.assets.types).names();
  int counted = 0;
  for (const SceneInstance& instance : scene.instances) {
    if (!instance.surrounds) continue;
    const SurroundingKind kind = things[instance.id - std::uint32_t(kFirstSurrounding)].kind;
    ASSERT_EQ(names.at(instance.label), surrounding_names()[std::size_t(kind)]);
    ++counted;
  }
  EXPECT_EQ(counted, int(things.size()));
}

double mean_light(const LinearFrame& frame) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    if (frame.depth[i] > 0) sum += double(frame.rgb[i * 3 + 1]), ++count;
  return sum / double(count);
}

TEST(SurroundingsRun, StreetLampsLightTheStreet) {
  const Settled& settled = settled_here();
  PileState pile = settled.pile;
  Scenario scenario = settled.mission.scenario;
  const Scene lit = build_scene(scenario, settled.mission.assets, pile);
  EXPECT_EQ(lit.more_lights.size(), kMostLights - 1);
  EXPECT_GE(lit.far_lights.size(), 3u);
  scenario.surroundings.lamps = StreetLampState::off;
  lay_surroundings(scenario, settled.mission.assets, pile);
  const Scene dark = build_scene(scenario, settled.mission.assets, pile);
  EXPECT_TRUE(dark.more_lights.empty());
  EXPECT_TRUE(dark.far_lights.empty());
  const Eye eye = towards_the_street();
  EXPECT_GT(mean_light(lit_street()), 5 * mean_light(render(dark, eye)));
  scenario.surroundings.lamps = StreetLampState::automatic;
  scenario.lights[0].sky.type = SkyType::clear, scenario.lights[0].spec.elevation_deg = 30;
  EXPECT_FALSE(is_dark(scenario));
  scenario.lights[0].spec.elevation_deg = -2;
  EXPECT_TRUE(is_dark(scenario));
}

// A lamp over a level slab gives I h / d^3 whether it is one of the sharp lights or a far one.
TEST(SurroundingsRun, FarLightsGiveTheLightOfTheOthers) {
  TriangleMesh slab;
  slab.positions = {{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}};
  slab.triangles = {{0, 1, 2}, {0, 2, 3}};
  auto mesh = std::make_shared<SceneMesh>();
  mesh->levels = {slab}, mesh->light_spacing = 0.5;
  Scene scene;
  scene.meshes = {mesh};
  scene.ground = false, scene.lamp.on = false;
  scene.light.type = LightType::point, scene.light.intensity = 0, scene.light.position = {0, 0, 50};
  SceneInstance instance;
  instance.surrounds = true;
  scene.instances = {instance};
  LightSpec lamp;
  lamp.type = LightType::spot, lamp.intensity = 1, lamp.cone_deg = 150, lamp.rpy_deg = {0, 90, 0}, lamp.position = {0, 0, 4};
  Eye eye = towards_the_street();
  eye.pose = {portable::quat_from_rpy(0, portable::kPi / 2, 0), {0, 0, 3.5}};
  Scene sharp = scene, far = scene;
  sharp.more_lights = {lamp}, far.far_lights = {lamp};
  const double none = mean_light(render(scene, eye, true)), of_sharp = mean_light(render(sharp, eye, true)),
               of_far = mean_light(render(far, eye, true));
  EXPECT_GT(of_sharp, 10 * none);
  EXPECT_NEAR(of_far / of_sharp, 1, 0.05);
}

// With street lamps, lit windows and baked light.
TEST(SurroundingsRun, ThreadsChangeNoBitOfAFrame) {
  const Settled& settled = settled_here();
  Scene scene = build_scene(settled.mission.scenario, settled.mission.assets, settled.pile);
  keep_near(scene, 20);
  Eye eye = towards_the_street();
  eye.k.width = 96, eye.k.height = 72, eye.k.fx = eye.k.fy = 48, eye.k.cx = 47.5, eye.k.cy = 35.5;
  const auto draw = [&](int threads) {
    SoftwareDevice device;
    RenderOptions options;
    options.threads = threads, options.bake_rays = 8;
    return Renderer(device, scene, options).render_linear(eye.pose, eye.k);
  };
  const LinearFrame one = draw(1), two = draw(2);
  EXPECT_TRUE(one.rgb == two.rgb);
  EXPECT_TRUE(one.instance == two.instance);
  int surrounding = 0;
  for (const std::uint32_t id : one.instance) surrounding += id >= std::uint32_t(kFirstSurrounding) && id < kNoInstance;
  EXPECT_GT(surrounding, 500) << "hardly anything of the street shows";
}

struct Triangle {
  Vec3 a, ab, ac;
};

std::vector<Triangle> read_stl(const std::string& path) {
  const std::string bytes = read_file(path);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < count; ++t) {
    Vec3f p[3];
    std::memcpy(p, bytes.data() + 84 + 50 * std::size_t(t) + 12, sizeof p);
    triangles.push_back({Vec3(p[0]), Vec3(p[1]) - Vec3(p[0]), Vec3(p[2]) - Vec3(p[0])});
  }
  return triangles;
}

// Moeller and Trumbore's test of every triangle in double precision, and the plane z = 0.
double cast_at_all(const std::vector<Triangle>& triangles, const Vec3& from, const Vec3& along) {
  double nearest = along.z < 0 ? -from.z / along.z : 1e9;
  for (const Triangle& t : triangles) {
    const Vec3 p = cross(along, t.ac);
    const double det = dot(t.ab, p);
    if (std::fabs(det) < 1e-14) continue;
    const Vec3 s = from - t.a;
    const double u = dot(s, p) / det;
    if (u < 0 || u > 1) continue;
    const Vec3 q = cross(s, t.ab);
    const double v = dot(along, q) / det;
    if (v < 0 || u + v > 1) continue;
    const double distance = dot(t.ac, q) / det;
    if (distance > 1e-6) nearest = std::min(nearest, distance);
  }
  return nearest;
}

// A sensor that stands, without noise, against the exported street.
TEST(SurroundingsRun, ALidarMeasuresTheStreetOfTheExport) {
  const ScratchFolder folder;
  std::string text = kMission;
  text.replace(text.find("outputs = {"), 11, R"(lidars = { top = { model = "vlp16", noise = false, range_step = 0,
      divergence_mrad = 0, range_at_10_percent = 500 } },
  outputs = { pcd = true,)");
  text.replace(text.find("-1, 3.1, 1.7"), 12, "-1, 3, 1.7");
  text.replace(text.find("frames = true"), 13, "frames = false");
  text.replace(text.find("width = 96"), 10, "quality = \"draft\", width = 96");
  write_file(folder / "m.lua", text);
  const Outcome run = run_rubble("run " + (folder / "m.lua") + " --quiet --out " + (folder / "out"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<Triangle> world = read_stl(folder / "out/pile.stl");
  Pose eye;
  double stamp = 0;
  std::istringstream(read_file(folder / "out/pcd/top/motion.txt")) >> stamp >> eye.translation.x >> eye.translation.y >> eye.translation.z >> eye.rotation.x >>
      eye.rotation.y >> eye.rotation.z >> eye.rotation.w;
  const std::string bytes = read_file(folder / "out/pcd/top/000000.pcd");
  int measured = 0, apart = 0, fronts = 0;
  for (std::size_t at = bytes.find("DATA binary\n") + 12; at + 22 <= bytes.size(); at += 22 * 29) {
    Vec3f p;
    std::memcpy(&p, bytes.data() + at, sizeof p);
    const Vec3 along = eye.rotation.rotate(Vec3(p));
    const double range = norm(along), expected = cast_at_all(world, eye.translation, along * (1 / range));
    ++measured, apart += std::fabs(range - expected) > 1e-4 * (1 + range);
    fronts += along.y < -12 && eye.translation.z + along.z > 1;
  }
  EXPECT_GT(measured, 500);
  EXPECT_GT(fronts, 50) << "hardly a ray met the fronts across the street";
  EXPECT_LE(apart, measured / 100) << "of " << measured;
}

// Light that was baked and shadow maps against paths.
TEST(SurroundingsRun, TheReferenceTracesThem) {
  const Settled& settled = settled_here();
  PileState pile = settled.pile;
  Scenario scenario = settled.mission.scenario;
  scenario.lights[0].sky.type = SkyType::overcast, scenario.lights[0].spec.elevation_deg = 40;
  lay_surroundings(scenario, settled.mission.assets, pile);
  const Scene scene = build_scene(scenario, settled.mission.assets, pile);
  Eye eye = towards_the_street();
  eye.k.width = 64, eye.k.height = 48, eye.k.fx = eye.k.fy = 32, eye.k.cx = 31.5, eye.k.cy = 23.5;
  const LinearFrame fast = render(scene, eye, true);
  SoftwareDevice device;
  RenderOptions options;
  options.threads = 1, options.colour.quality = RenderQuality::reference, options.colour.samples = 16;
  const LinearFrame traced = Renderer(device, scene, options).render_linear(eye.pose, eye.k);
  EXPECT_EQ(fast.instance, traced.instance);
  EXPECT_EQ(0, std::memcmp(fast.depth.data(), traced.depth.data(), fast.depth.size() * sizeof(float)));
  // 0.93, 0.99 and 0.98 for seeds 5, 6 and 7.
  EXPECT_NEAR(mean_light(fast) / mean_light(traced), 1, 0.1);
}

TEST_F(SettledStreet, IsSaidToBeLeftOutOfPagesAndSections) {
  ASSERT_EQ(run_rubble("view " + out).exit_code, 0);
  ASSERT_EQ(run_rubble("view " + bare).exit_code, 0);
  EXPECT_IN("not on this page: surroundings", read_file(out + "/view.html"));
  EXPECT_EQ(read_file(bare + "/view.html").find("not on this page"), std::string::npos);
  // Of the two pictures, all but the line below is the same.
  ASSERT_EQ(run_rubble("cutaway --width 400 " + out).exit_code, 0);
  ASSERT_EQ(run_rubble("cutaway --width 400 " + bare).exit_code, 0);
  const RgbImage with = read_rgb_png(out + "/cutaway.png"), without = read_rgb_png(bare + "/cutaway.png");
  ASSERT_EQ(with.width, without.width);
  ASSERT_EQ(with.height, without.height);
  const std::size_t row = std::size_t(with.width) * 3, caption = std::size_t(with.height - 40) * row;
  EXPECT_EQ(0, std::memcmp(with.rgb.data(), without.rgb.data(), caption));
  EXPECT_NE(with.rgb, without.rgb) << "the line below says nothing of surroundings";
}

TEST(SurroundingsRun, MistakesAreShownWithTheirLines) {
  const ScratchFolder folder;
  const auto check = [&](const std::string& text) {
    write_file(folder / "m.lua", "return rubble.mission {\n  seed = 1,\n  surroundings = " + text + ",\n}\n");
    const Outcome outcome = run_rubble("check " + (folder / "m.lua"));
    EXPECT_EQ(outcome.exit_code, 1) << text;
    return outcome.err;
  };
  EXPECT_IN("m.lua:3: surroundings.type", check("{ type = \"stret\" }"));
  EXPECT_IN("did you mean `vehicles`?", check("{ vehicels = 1 }"));
  EXPECT_IN("40 to 400", check("{ reach = 5 }"));
  EXPECT_IN("surroundings.storeys", check("{ storeys = { 5, 2 } }"));
  EXPECT_IN("whole numbers", check("{ storeys = { 2, 3.5 } }"));
  EXPECT_IN("their own ground", check("{ type = \"street\" },\n  pile = { terrain = { columns = 2, rows = 2, heights = { 0, 0, 0, 0 } } }"));
}

}  // namespace surroundings_run_test
}  // namespace rubble::testing
