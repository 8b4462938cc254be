// Fines in runs: in pictures, depth, labels, exports and files, the same when made again, carried by what moves,
// and nothing of them where a mission has none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <set>

#include "app/fines/pile_fines.h"
#include "app/mission/finished_run.h"
#include "app/pipeline/stages.h"
#include "app/scene/build_scene.h"
#include "app/scene/moving_scene.h"
#include "io/state/fines_file.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/queries/queries.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace fines_run_test {

namespace fs = std::filesystem;

// Bricks before a wall, and a camera that looks at its foot.
const char* const kMission = R"(
return rubble.mission {
  seed = 5,
  fines = { amount = 800, drifts = 4, cables = 1, pipes = 1, size = { 0.01, 0.05 } },
  pile = { layers = 1, pieces_per_layer = 12, spawn_bounds = { 1.5, 1.5, 1 }, spawn_position = { 0, 0, 1.5 },
           mix = { { asset = "brick", scale = { 1, 2 } } },
           placed = { { box = { 0.2, 3, 1.2 }, position = { 1.2, 0, 0.6 } }, { box = { 3, 0.2, 1.2 }, position = { 0, 1.2, 0.6 } } } },
  camera = { width = 160, height = 120, channels = { "label", "instance" } },
  outputs = { frames = true, meshes = { "glb" } },
  trajectory = { rate_hz = 5, waypoints = { { t = 0, position = { -0.6, -0.6, 0.7 }, look_at = { 0.9, 0.9, 0 } },
                                            { t = 0.2, position = { -0.6, -0.5, 0.7 }, look_at = { 0.9, 0.9, 0 } } } },
})";

struct Settled {
  ResolvedMission mission;
  PileState pile;
};

Settled settle_here(const ScratchFolder& folder) {
  write_file(folder / "m.lua", kMission);
  RunRequest request;
  request.mission = folder / "m.lua", request.options.quiet = true, request.options.threads = 2;
  RunContext context(request.options);
  Settled settled{resolve_mission(request, RunKind::settle, context), {}};
  settled.pile = settle_in_memory(settled.mission, context, [] { return true; }).state;
  return settled;
}

std::uint32_t count_triangles(const std::string& stl) {
  const std::string bytes = read_file(stl);
  return std::uint32_t(std::uint8_t(bytes[80])) | std::uint32_t(std::uint8_t(bytes[81])) << 8 |
         std::uint32_t(std::uint8_t(bytes[82])) << 16;
}

TEST(FinesRun, HasThemInEveryProductAndTheSameWhenItIsMadeAgain) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", kMission);
  const std::string out = folder / "out", bare = folder / "bare";
  const Outcome run = run_rubble("run " + (folder / "m.lua") + " --quiet --threads 1 --out " + out);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(run_rubble("run " + (folder / "m.lua") + " --quiet --set fines.amount=0 --out " + bare).exit_code, 0);
  // The pile is that without them; what is new is in its own file.
  EXPECT_EQ(read_state_hash(out), read_state_hash(bare));
  EXPECT_EQ(read_file(out + "/pile.bin"), read_file(bare + "/pile.bin"));
  EXPECT_FALSE(fs::exists(bare + "/fines.bin"));
  EXPECT_EQ(read_outputs(bare).count("fines.bin"), 0u);
  EXPECT_EQ(read_file(bare + "/labels.csv").find("grit"), std::string::npos);
  EXPECT_IN(",grit\n", read_file(out + "/labels.csv"));
  const PileState pile = load_pile_of(open_finished_run(out));
  std::size_t triangles = 0;
  for (const FineHeap& heap : pile.fines.heaps()) triangles += heap.mesh.triangles.size();
  EXPECT_GT(triangles, 5000u);
  EXPECT_EQ(count_triangles(out + "/pile.stl"), count_triangles(bare + "/pile.stl") + triangles);
  EXPECT_IN("grit_10000000", read_file(out + "/pile.glb"));
  EXPECT_IN("\"instance\":10000000", read_file(out + "/frames/legend.json"));
  EXPECT_EQ(run_rubble("verify --quiet --threads 2 " + out).exit_code, 0);
  const Outcome remake = run_rubble("remake --quiet " + out + "/manifest.json --out " + (folder / "again"));
  EXPECT_EQ(remake.exit_code, 0) << remake.out << remake.err;
  EXPECT_EQ(reproducible(folder / "again"), reproducible(out));
  // A camera of another mission over the same pile sees them, too.
  const Outcome render = run_rubble("render " + out + " --quiet --mission scripts/small.lua --out " + (folder / "other"));
  ASSERT_EQ(render.exit_code, 0) << render.err;
  EXPECT_EQ(read_file(folder / "other/fines.bin"), read_file(out + "/fines.bin"));
  // The verdict of info depends on them: a run without its fines is not whole.
  fs::remove(out + "/fines.bin");
  EXPECT_NE(run_rubble("info " + out).exit_code, 0);
}

// Of what a pixel's depth says, against a ray through the middle of the pixel in double precision.
TEST(FinesRun, DepthAndLabelsAreThoseOfTheTrueMeshes) {
  const ScratchFolder folder;
  const Settled settled = settle_here(folder);
  const Scenario& scenario = settled.mission.scenario;
  const AssetLibrary& assets = settled.mission.assets;
  const PileQueries queries(settled.pile, assets.finest_meshes());
  SoftwareDevice device;
  RenderOptions options;
  options.threads = 2, options.bake = false;
  const Scene scene = build_scene(scenario, assets, settled.pile);
  Renderer renderer(device, scene, options);
  Intrinsics k;
  k.width = 320, k.height = 240, k.fx = k.fy = 220, k.cx = 159.5, k.cy = 119.5;
  const Pose eye{portable::quat_from_rpy(0, 0.6, 0.78), {-0.4, -0.4, 0.8}};
  const LinearFrame frame = renderer.render_linear(eye, k);
  const std::vector<FineHeap>& heaps = settled.pile.fines.heaps();
  int seen = 0, apart = 0;
  std::set<int> kinds;
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const Vec3 along = (eye * camera_from_optical).rotation.rotate({(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1});
      const auto hit = queries.cast_ray(eye.translation, along, 50);
      if (!hit || hit->piece < kFirstFineHeap) continue;
      const auto i = std::size_t(v) * std::size_t(k.width) + std::size_t(u);
      const FineKind kind = heaps[std::size_t(hit->piece - kFirstFineHeap)].kind;
      ++seen, kinds.insert(int(kind));
      const double expected = hit->distance / norm(along);
      const bool same = std::fabs(double(frame.depth[i]) - expected) < 1e-4 && frame.instance[i] == std::uint32_t(hit->piece);
      apart += !same;  // a pixel whose middle is on an edge, to within rounding
    }
  EXPECT_GT(seen, 2000);
  EXPECT_GE(kinds.size(), 3u);
  EXPECT_LE(apart, seen / 500);
  const std::vector<std::string> names = ClassLabels(scenario, assets.types).names();
  for (const SceneInstance& instance : scene.instances) {
    if (instance.id < std::uint32_t(kFirstFineHeap)) continue;
    const FineKind kind = heaps[instance.id - std::uint32_t(kFirstFineHeap)].kind;
    EXPECT_EQ(names.at(instance.label), fine_names()[std::size_t(kind)]);
  }
}

TEST(FinesRun, GoWithThePieceThatTheyLieOn) {
  const ScratchFolder folder;
  const Settled settled = settle_here(folder);
  std::vector<int> hosts;
  for (const FineHeap& heap : settled.pile.fines.heaps()) hosts.push_back(heap.host);
  const auto on_piece = std::find_if(hosts.begin(), hosts.end(), [](int host) { return host >= 2; });
  ASSERT_NE(on_piece, hosts.end()) << "no fines on a brick";
  RobotTrack robots;
  TrackBody body;
  body.id = *on_piece;
  Pose there = settled.pile.pieces[std::size_t(*on_piece)].world_from_body;
  body.keys.push_back({0, there, {}, {}});
  there.translation.x += 0.5;
  body.keys.push_back({1, there, {}, {}});
  robots.track.times = {0, 1};
  robots.track.bodies = {body};
  const Scene scene = build_robot_scene(settled.mission.scenario, settled.mission.assets, settled.pile, robots, 0);
  std::set<std::uint32_t> moving;
  for (const std::uint32_t i : scene.motion.moving) moving.insert(scene.instances[i].id);
  std::set<std::uint32_t> expected{std::uint32_t(*on_piece)};
  for (std::size_t i = 0; i < hosts.size(); ++i)
    if (hosts[i] == *on_piece) expected.insert(std::uint32_t(kFirstFineHeap) + std::uint32_t(i));
  EXPECT_EQ(moving, expected);
  EXPECT_GE(expected.size(), 2u);
}

TEST(FinesRun, FileGivesBackWhatWasSavedAndRefusesWhatIsNotWhole) {
  const ScratchFolder folder;
  const Settled settled = settle_here(folder);
  const std::string file = folder / "fines.bin";
  save_fines(settled.pile.fines, file);
  const Fines back = load_fines(file, settled.pile.pieces.size());
  save_fines(back, folder / "again.bin");
  EXPECT_EQ(read_file(file), read_file(folder / "again.bin"));
  EXPECT_EQ(back.pieces.size(), settled.pile.fines.pieces.size());
  EXPECT_THROW(load_fines(file, 1), InputError) << "they lie on pieces that are not there";
  std::string bytes = read_file(file);
  bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
  write_file(file, bytes);
  EXPECT_THROW(load_fines(file, settled.pile.pieces.size()), InputError);
  write_file(file, bytes.substr(0, bytes.size() / 2));
  EXPECT_THROW(load_fines(file, settled.pile.pieces.size()), InputError);
}

// A million on so little ground takes minutes.
TEST(FinesRun, ASignalEndsTheStrewing) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", kMission);
  const Outcome stopped = run_rubble_and_signal("settle " + (folder / "m.lua") + " --set fines.amount=1000000 --out " + (folder / "run"),
                                                [](const std::string& said) { return said.find("fines ...") != std::string::npos; }, SIGTERM);
  EXPECT_EQ(stopped.exit_code, 4) << stopped.err;
  EXPECT_IN("rubble resume " + (folder / "run"), stopped.err);
  EXPECT_FALSE(fs::exists(folder / "run/pile.bin"));
}

TEST(FinesRun, MistakesAreShownWithTheirLines) {
  const ScratchFolder folder;
  const auto check = [&](const std::string& fines) {
    write_file(folder / "m.lua", "return rubble.mission {\n  seed = 1,\n  fines = " + fines + ",\n}\n");
    const Outcome outcome = run_rubble("check " + (folder / "m.lua"));
    EXPECT_EQ(outcome.exit_code, 1) << fines;
    return outcome.err;
  };
  const std::string negative = check("{ amount = -5 }");
  EXPECT_IN("m.lua:3: fines.amount", negative);
  EXPECT_IN("0 to 1000000", negative);
  EXPECT_IN("did you mean `amount`?", check("{ amuont = 5 }"));
  EXPECT_IN("fines.size", check("{ amount = 5, size = { 0.05, 0.003 } }"));
  EXPECT_IN("share above 0", check("{ amount = 5, grit = 0, plaster = 0, glass = 0, paper = 0, cloth = 0 }"));
}

}  // namespace fines_run_test
}  // namespace rubble::testing
