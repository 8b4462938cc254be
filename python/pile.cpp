// settle(), open_pile() and the Pile: what lies where, rays, distances, voids.

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "app/assets/asset_library.h"
#include "app/control/robot_control.h"
#include "app/mission/finished_run.h"
#include "app/pipeline/stages.h"
#include "app/surroundings/pile_surroundings.h"
#include "app/scene/build_scene.h"
#include "app/support/print.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/geometry/fine_shapes.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"
#include "python/arrays.h"
#include "python/parts.h"
#include "scripting/mission.h"

namespace rubble::python {

RunOptions quiet(int threads) {
  RunOptions options;
  options.quiet = true;
  options.threads = threads;
  return options;
}

namespace {

constexpr int kGrain = 64;  // rays or points that a thread takes at once

// A pile and its queries, which are made when they are first asked for.
struct Pile {
  SharedPile settled;
  int threads = 1;
  std::shared_ptr<PileQueries> made{};

  const PileQueries& queries() {
    if (!made)
      made = std::make_shared<PileQueries>(settled->state, settled->mission.assets.finest_meshes());
    return *made;
  }
};

Pile settle(const nb::object& mission, const nb::object& seed, const nb::object& overrides, const nb::object& threads) {
  RunRequest request;
  request.mission = to_path(mission, "mission"), request.overrides = to_overrides(overrides, "overrides");
  if (!seed.is_none()) request.seed = to_mission_seed(seed);
  RunContext context(quiet(to_threads(threads)));
  auto settled = std::make_shared<SettledMission>();
  settled->mission = resolve_mission(request, RunKind::settle, context);
  check_robot_models(settled->mission.scenario, settled->mission.assets, settled->mission.provenance.script);
  settled->state = settle_in_memory(settled->mission, context, [] { return true; }).state;
  return {settled, context.threads()};
}

// Without the files of its robots a pile is whole, but none of them can be driven. Throws InputError where they changed.
void recall_robots_if_there(const Provenance& provenance, const std::vector<std::string>& folders, AssetLibrary& library) {
  AssetLibrary tried;
  try {
    add_robot_files(stated_scenario(provenance).robots, folders, tried);
  } catch (const InputError& error) {
    print_warnings({std::string(error.what()) + "; its robots cannot be driven"});
    return;
  }
  recall_robots(provenance, folders, library);
}

Pile open_pile(const nb::object& folder, const nb::object& threads, const nb::object& assets) {
  RunContext context(quiet(to_threads(threads)));
  std::vector<std::string> packs = to_folders(assets, "assets");
  const FinishedRun saved = open_finished_run(to_path(folder, "folder"));
  auto settled = std::make_shared<SettledMission>();
  packs.insert(packs.end(), saved.manifest.pack_folders.begin(), saved.manifest.pack_folders.end());
  settled->mission = resolve_pile(saved.manifest.provenance, packs, context);
  settled->state = load_pile_of(saved, settled->mission.assets);
  recall_robots_if_there(saved.manifest.provenance, packs, settled->mission.assets);
  return {settled, context.threads()};
}

// Whether two scenarios settle the same pile.
bool settles_alike(const Scenario& base, const Scenario& changed) {
  Scenario same = changed;
  adopt_pile(same, base);
  same.surroundings = base.surroundings, same.seed = base.seed;
  return scenario_to_json(same) == scenario_to_json(changed);
}

// The same pile under other keys of its mission: light, air, cameras, sensors, robots.
Pile vary(const Pile& pile, const nb::object& given) {
  const std::vector<std::string> overrides = to_overrides(given, "overrides");
  const ResolvedMission& base = pile.settled->mission;
  const auto load = [&base](const std::vector<std::string>& more) {
    Provenance changed = base.provenance;
    changed.overrides.insert(changed.overrides.end(), more.begin(), more.end());
    return load_mission(changed);
  };
  const Mission mission = load(overrides);
  const Scenario& changed = mission.scenario;
  if (!settles_alike(base.scenario, changed)) {
    for (const std::string& one : overrides)
      if (!settles_alike(base.scenario, load({one}).scenario))
        throw InputError({"", 0, one.substr(0, one.find('=')), "this key changes how the pile settled",
                          "keys of light, air, cameras, sensors or robots", one, "settle the mission with this key anew"});
    throw InputError({"", 0, "overrides", "these keys change how the pile settled",
                      "keys of light, air, cameras, sensors or robots", "", "settle the mission with them anew"});
  }
  print_warnings(find_suspicious(mission));
  auto varied = std::make_shared<SettledMission>(*pile.settled);
  varied->mission.scenario = changed;
  // Lamps burn and puddles lie by the light and the weather.
  const bool other_surroundings = changed.surroundings.on() && (is_dark(changed) != is_dark(base.scenario) || changed.wetness != base.scenario.wetness);
  if (other_surroundings) lay_surroundings(changed, base.assets, varied->state);
  varied->mission.provenance.overrides.insert(varied->mission.provenance.overrides.end(), overrides.begin(), overrides.end());
  return {varied, pile.threads, other_surroundings ? nullptr : pile.made};
}

Array<double> poses_of(const Pile& pile) {
  const auto& pieces = pile.settled->state.pieces;
  Array<double> out = make_array<double>({Size(pieces.size()), 7});
  for (std::size_t i = 0; i < pieces.size(); ++i) put_pose(pieces[i].world_from_body, out.data() + 7 * i);
  return out;
}

std::vector<std::string> assets_of(const Pile& pile) {
  std::vector<std::string> names;
  for (const PieceState& piece : pile.settled->state.pieces)
    names.push_back(pile.settled->state.types[std::size_t(piece.type)]);
  return names;
}

template <typename Ask>
void ask_each(const Pile& pile, std::size_t count, const Ask& ask) {
  ThreadPool pool(pile.threads);
  const nb::gil_scoped_release free;
  pool.run(int(count), kGrain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) ask(std::size_t(i));
  });
}

nb::dict cast_rays(Pile& pile, const DoubleArray& origins, const DoubleArray& directions, double max_distance) {
  const std::vector<Vec3> from = to_points(origins, "origins"), along = to_points(directions, "directions");
  expect_positive(max_distance, "max_distance");
  if (from.size() != along.size() && from.size() != 1)
    throw InputError({"", 0, "origins", "not as many as directions", std::to_string(along.size()) + (along.size() == 1 ? "" : ", or 1 for all"),
                      std::to_string(from.size()), ""});
  for (const Vec3& d : along)
    if (!(norm(d) > 0 && std::isfinite(norm(d))))
      throw InputError({"", 0, "directions", "no direction", "a length above 0 and below 1e150", exact_text(norm(d)), ""});
  const PileQueries& queries = pile.queries();
  const auto count = along.size();
  std::vector<double> distance(count, std::numeric_limits<double>::infinity()), normals(3 * count, 0);
  std::vector<std::int32_t> pieces(count, -2);
  ask_each(pile, count, [&](std::size_t i) {
    const auto hit = queries.cast_ray(from[from.size() == 1 ? 0 : i], along[i], max_distance);
    if (!hit) return;
    distance[i] = hit->distance, pieces[i] = hit->piece;
    for (int k = 0; k < 3; ++k) normals[3 * i + std::size_t(k)] = hit->normal[k];
  });
  nb::dict out;
  out["distance"] = take_vector(std::move(distance), {Size(count)});
  out["normal"] = take_vector(std::move(normals), {Size(count), 3});
  out["piece"] = take_vector(std::move(pieces), {Size(count)});
  return out;
}

Array<double> clearance(Pile& pile, const DoubleArray& at, double max_distance) {
  const std::vector<Vec3> points = to_points(at, "points");
  expect_positive(max_distance, "max_distance");
  const PileQueries& queries = pile.queries();
  std::vector<double> out(points.size());
  ask_each(pile, points.size(), [&](std::size_t i) { out[i] = queries.clearance(points[i], max_distance); });
  return take_vector(std::move(out), {Size(points.size())});
}

nb::dict describe(const Void& v, const VoidSpace& space) {
  nb::dict out;
  out["volume"] = v.volume, out["depth"] = v.depth, out["path_length"] = v.path_length;
  out["widest"] = from_vector(v.widest), out["widest_radius"] = v.widest_radius;
  out["deepest"] = from_vector(v.deepest), out["bottleneck_radius"] = v.bottleneck_radius;
  nb::list entrances;
  for (const Entrance& e : v.entrances) {
    nb::dict one;
    one["position"] = from_vector(e.position), one["inward"] = from_vector(e.inward);
    one["radius"] = e.radius, one["area"] = e.area;
    entrances.append(one);
  }
  out["entrances"] = entrances;
  std::vector<double> cells;
  for (const std::uint32_t cell : v.cells)
    for (int k = 0; k < 3; ++k) cells.push_back(space.grid.centre(cell)[k]);
  out["cells"] = take_vector(std::move(cells), {Size(v.cells.size()), 3});
  return out;
}

nb::list voids(const Pile& pile, double radius, double voxel) {
  VoidSpaceOptions options;
  options.voxel = voxel;
  options.rolling_radius = outside_radius_for(options.rolling_radius, radius);
  options.scenery = pile.settled->mission.assets.terrain();
  options.threads = pile.threads;
  options.margin = 0;
  VoidMap map;
  {
    const nb::gil_scoped_release free;
    map = find_voids(calc_void_space(pile.settled->state, pile.settled->mission.assets.finest_meshes(), options),
                     {radius});
  }
  nb::list out;
  for (const Void& v : map.robots.front().voids) out.append(describe(v, map.space));
  return out;
}

// All pieces as one mesh, at their finest, and then the fines.
nb::tuple mesh_of(const Pile& pile) {
  const auto meshes = pile.settled->mission.assets.finest_meshes();
  std::vector<float> positions;
  std::vector<std::int32_t> triangles;
  const auto add = [&](const TriangleMesh& mesh, const Pose& world_from_body, double scale) {
    const auto base = std::int32_t(positions.size() / 3);
    for (const Vec3f& p : mesh.positions) {
      const Vec3 at = world_from_body * (Vec3(p) * scale);
      for (int k = 0; k < 3; ++k) positions.push_back(float(at[k]));
    }
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : t) triangles.push_back(base + std::int32_t(v));
  };
  const PileState& state = pile.settled->state;
  for (const PieceState& piece : state.pieces)
    if (piece.status != PieceStatus::lost) add(*meshes[std::size_t(piece.type)], piece.world_from_body, piece.scale);
  for (const FineHeap& heap : state.fines.heaps()) add(heap.mesh, world_from_host(state, heap.host), 1);
  const auto vertices = Size(positions.size() / 3), faces = Size(triangles.size() / 3);
  return nb::make_tuple(take_vector(std::move(positions), {vertices, 3}), take_vector(std::move(triangles), {faces, 3}));
}

// The complete scenario as JSON; what `rubble check` prints.
std::string check_mission(const nb::object& script, const nb::object& seed, const nb::object& overrides) {
  MissionOptions options;
  options.overrides = to_overrides(overrides, "overrides");
  if (!seed.is_none()) options.seed = to_mission_seed(seed);
  const Mission mission = load_mission(to_path(script, "script"), options);
  const AssetLibrary assets = load_assets(mission, {});
  print_warnings(assets.warnings);
  check_robot_models(mission.scenario, assets, mission.script);
  return scenario_to_json(mission.scenario);
}

// The same without its assets, and the keys that are stated in vain.
nb::tuple load_scenario(const nb::object& script, const nb::object& seed, const nb::object& overrides) {
  MissionOptions options;
  options.overrides = to_overrides(overrides, "overrides");
  if (!seed.is_none()) options.seed = to_mission_seed(seed);
  const Mission mission = load_mission(to_path(script, "script"), options);
  nb::list idle;
  for (const Diagnostic& d : mission.idle_keys) idle.append(d.key);
  return nb::make_tuple(scenario_to_json(mission.scenario), idle);
}

void set_sandbox(const nb::object& folder) {
  folder.is_none() ? leave_sandbox() : enter_sandbox_of_missions(to_path(folder, "folder"));
}

}  // namespace

void add_pile(nb::module_& module) {
  nb::class_<Pile>(module, "Pile", "A settled pile: what lies where, and questions about it. Metres, world frame.")
      .def_prop_ro("state_hash", [](const Pile& p) { return p.settled->state.state_hash(); },
                             "64 bits over every piece's state: equal piles have equal hashes.")
      .def_prop_ro("settled", [](const Pile& p) { return p.settled->state.settled; },
                             "Whether every piece came to a checked rest.")
      .def_prop_ro("poses", &poses_of, nb::rv_policy::automatic, "(n, 7): x y z qw qx qy qz of every piece, world from body.")
      .def_prop_ro("assets", &assets_of, "The name of every piece's asset.")
      .def_prop_ro("seed", [](const Pile& p) { return p.settled->mission.scenario.seed; })
      .def("__len__", [](const Pile& p) { return p.settled->state.pieces.size(); })
      .def("cast_rays", &cast_rays, nb::arg("origins"), nb::arg("directions"), nb::arg("max_distance") = 100.0,
           "What rays from origins along directions, (n, 3) each or one origin for all, meet up to max_distance (unit: m): dict of\n"
           "distance (inf: nothing; unit: m), normal (0: nothing) and piece (an index of poses; -1: ground, -2: nothing). Beyond 600 km\n"
           "from the pile pieces are missed.")
      .def("clearance", &clearance, nb::arg("points"), nb::arg("max_distance") = 10.0,
           "How far each of n points (n, 3) is from everything solid, at most max_distance; 0 inside a piece and below the ground.\n"
           "Unit: m.")
      .def("voids", &voids, nb::arg("radius"), nb::arg("voxel") = 0.05,
           "The voids that a ball of that radius has room in, the largest first.")
      .def("mesh", &mesh_of, "(vertices (n, 3) float32, triangles (m, 3) int32) of all pieces.")
      .def("vary", &vary, nb::arg("overrides"),
           "The same pile under other keys of its mission (\"key=value\"): light, air, cameras, sensors, robots. Nothing "
           "settles again.")
      .def_prop_ro("_shared", [](const Pile& p) { return p.settled; })
      .def_prop_ro("threads", [](const Pile& p) { return p.threads; });
  nb::class_<SettledMission>(module, "_Settled");
  module.def("settle", &settle, nb::arg("mission"), nb::arg("seed") = nb::none(),
             nb::arg("overrides") = nb::make_tuple(), nb::arg("threads") = 0,
             "Settles the pile of a mission script. overrides: \"key=value\", as rubble run --set.");
  module.def("_scenario", &load_scenario, nb::arg("script"), nb::arg("seed") = nb::none(), nb::arg("overrides") = nb::list());
  module.def("check_mission", &check_mission, nb::arg("script"), nb::arg("seed") = nb::none(),
             nb::arg("overrides") = nb::make_tuple());
  // What an argument that is a list of overrides has; raises InputError for a single text.
  module.def("_overrides", &to_overrides, nb::arg("values"), nb::arg("name") = "overrides");
  module.def("_folders", &to_folders, nb::arg("values"), nb::arg("name") = "assets");
  module.def("_threads", &to_threads, nb::arg("threads"));
  module.def("set_sandbox", &set_sandbox, nb::arg("folder").none(),
             "From now on this process reads missions, packs and what they name only below that folder, as rubble --sandbox; "
             "None: everywhere again. Folders given to open_pile stay open.");
  module.def("open_pile", &open_pile, nb::arg("folder"), nb::arg("threads") = 0,
             nb::arg("assets") = nb::make_tuple(),
             "The settled pile of a finished run. assets: folders of packs, terrain meshes and URDF files that are not bundled.");
}

}  // namespace rubble::python
