#include "app/drive/drive_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/control/robot_control.h"
#include "app/drive/drive_log.h"
#include "app/mission/scenario_lua.h"
#include "app/planning/flight.h"
#include "app/scene/build_scene.h"
#include "app/sensors/camera_renderers.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"
#include "scripting/sandbox/script_file.h"

namespace rubble {
namespace {

constexpr double kMargin = 1;     // around what there is; unit: m
constexpr double kFromAbove = 100;  // rays start so high; unit: m

Vec3 place_of(const MapFrame& frame, int column, int row) {
  const double step = frame.side / frame.pixels;
  return frame.centre + Vec3((column + 0.5) * step - frame.side / 2,
                             frame.side / 2 - (row + 0.5) * step, 0);
}

std::vector<double> measure_heights(const PileQueries& queries, const MapFrame& frame,
                                    int threads) {
  const auto side = std::size_t(frame.pixels);
  std::vector<double> heights(side * side);
  parallel_for(side, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < side; ++column) {
      Vec3 from = place_of(frame, int(column), int(row));
      from.z = kFromAbove;
      const auto hit = queries.cast_ray(from, {0, 0, -1}, 2 * kFromAbove);
      heights[row * side + column] = hit ? hit->point.z : 0;
    }
  });
  return heights;
}

}  // namespace

double MapFrame::column(const Vec3& p) const {
  return (p.x - centre.x + side / 2) / side * pixels - 0.5;
}
double MapFrame::row(const Vec3& p) const {
  return (centre.y + side / 2 - p.y) / side * pixels - 0.5;
}

MapFrame frame_map(const PileState& pile, const Vec3& camera, int pixels) {
  Aabb box;
  box.include(camera);
  for (const PieceState& piece : pile.pieces)
    if (piece.status != PieceStatus::lost) box.include(piece.world_from_body.translation);
  MapFrame frame;
  frame.centre = (box.min + box.max) * 0.5;
  frame.side = std::max(box.max.x - box.min.x, box.max.y - box.min.y) + 2 * kMargin;
  frame.pixels = pixels;
  return frame;
}

RgbImage draw_height_map(const PileQueries& queries, const MapFrame& frame, int threads) {
  const std::vector<double> heights = measure_heights(queries, frame, threads);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double lowest = *low, range = std::max(0.5, *high - lowest);  // of a hillside, too
  const double step = frame.side / frame.pixels;
  RgbImage image{frame.pixels, frame.pixels, {}};
  for (int row = 0; row < frame.pixels; ++row)
    for (int column = 0; column < frame.pixels; ++column) {
      const auto at = [&](int r, int c) {
        r = std::clamp(r, 0, frame.pixels - 1), c = std::clamp(c, 0, frame.pixels - 1);
        return heights[std::size_t(r * frame.pixels + c)];
      };
      const double height = (at(row, column) - lowest) / range;
      const double slope = (at(row + 1, column + 1) - at(row - 1, column - 1)) / (2 * step);
      const double light = (60 + 150 * height) * (1 - std::clamp(0.35 * slope, -0.35, 0.5));
      for (const double tint : {1.0, 0.97, 0.88})
        image.rgb.push_back(std::uint8_t(std::clamp(light * tint, 0.0, 255.0)));
    }
  return image;
}

namespace {

constexpr double kLeastRate = 5, kMostRate = 120;  // of steps that a person can steer by; unit: Hz

// A calibrated lens sees the same through fewer pixels.
void resize_camera(CameraScenario& camera, int width, int height) {
  const double sx = double(width) / camera.width, sy = double(height) / camera.height;
  LensScenario& lens = camera.lens;
  if (lens.fx) lens.fx = *lens.fx * sx;
  if (lens.fy) lens.fy = *lens.fy * sy;
  if (lens.cx) lens.cx = (*lens.cx + 0.5) * sx - 0.5;
  if (lens.cy) lens.cy = (*lens.cy + 0.5) * sy - 0.5;
  camera.width = width;
  camera.height = height;
}

// Where the mission's own flight begins, places in voids included.
DrivenPose find_entry(const Scenario& scenario, PileSurvey& survey) {
  Scenario first = scenario;
  first.trajectory.waypoints.resize(1);
  first.trajectory.plan = Plan::ghost;
  first.trajectory.duration.reset();
  const FlightPlan plan = resolve_flight(first, survey);
  return make_driven_pose(plan.poses.front().world_from_camera);
}

void check_entry(const DriveWorld& world) {
  const double radius = world.scenario.trajectory.radius;
  const DrivenCamera camera(world.entry, world.plan, radius, world.queries());
  if (camera.has_room()) return;
  char found[64];
  std::snprintf(found, sizeof found, "%.3f m",
                world.queries().clearance(world.entry.position));
  throw InputError({"", 0, "trajectory.waypoints[1].position",
                    "the camera's body does not fit at the start of the flight",
                    "trajectory.radius = " + brief_text(radius) + " m of clearance", found,
                    "move it, make trajectory.radius smaller, or use plan = \"ghost\""});
}

DriveLimits limits_of(const TrajectorySpec& spec) {
  DriveLimits limits;
  if (spec.limits.max_speed) limits.most_speed = *spec.limits.max_speed;
  if (spec.limits.max_turn_rate_deg) {
    limits.most_turn_rate_deg = *spec.limits.max_turn_rate_deg;
    limits.turn_rate_deg = std::min(limits.turn_rate_deg, limits.most_turn_rate_deg);
  }
  limits.least_speed = std::min(limits.least_speed, limits.most_speed);
  limits.speed = spec.speed;
  return limits;
}

void refuse_several_cameras(const ResolvedMission& mission) {
  if (!mission.scenario.names_cameras()) return;
  const SourceFile& script = mission.provenance.script;
  std::vector<Diagnostic> mistakes{{"", 0, "cameras", "several cameras cannot be driven",
                                    "a mission with `camera`", "`cameras`",
                                    "fly it with `rubble run`, or drive a mission with one of them"}};
  locate(mistakes, script.path, SourceMap(script.text, "mission"));
  throw InputError(std::move(mistakes));
}

// The camera rides: it has no body of its own, and nothing stops it.
void enter_robots(const DriveRequest& request, const ResolvedMission& mission, RunContext& run, DriveWorld& world) {
  if (request.record)
    throw InputError({"", 0, "--record", "nothing is recorded while a robot is driven", "", "",
                      "run the mission of the drive with `rubble run`; it records everything"});
  world.robots = with_lines_of_script(
      mission, [&] { return std::make_unique<RobotDrive>(mission, world.pile, request.robot, run); });
  // The camera of the drive, and of the mission that is saved, is on the robot.
  if (world.scenario.record_settling.on)
    print_err("drive: without record_settling: the camera is on the robot, which starts when the pile rests\n");
  world.scenario.record_settling = {};
  world.plan = Plan::ghost;
  world.entry = make_driven_pose(world.robots->world_from_rig());
}

void adapt(DriveWorld& world, const DriveRequest& request) {
  Scenario& scenario = world.scenario;
  resize_camera(scenario.cameras.front().camera, request.width, request.height);
  // The mission that is saved lies elsewhere.
  scenario = with_whole_paths(scenario, world.assets, !request.of.asset_packs.empty());
  const double rate = scenario.trajectory.rate_hz;
  if (rate < kLeastRate) world.steps_per_frame = int(std::ceil(TrajectorySpec{}.rate_hz / rate));
  if (rate > kMostRate) print_err("drive: %g frames a second are asked for: time goes as slowly as they are drawn\n", rate);
  for (const std::string& off : adapt_to_driving(scenario))
    print_err("drive: without %s, which needs the future path\n", off.c_str());
}

}  // namespace

std::unique_ptr<DriveWorld> make_drive_world(const DriveRequest& request,
                                             std::optional<std::uint64_t> seed, const GoOn& go_on) {
  RunRequest of = request.of;
  if (seed) of.seed = seed;
  auto world = std::make_unique<DriveWorld>();
  world->run = std::make_unique<RunContext>(of.options);
  RunContext& run = *world->run;
  ResolvedMission mission = resolve_mission(of, RunKind::run, run);
  refuse_several_cameras(mission);
  check_robot_models(mission.scenario, mission.assets, mission.provenance.script);
  world->threads = run.threads();
  world->pile = settle_in_memory(mission, run, go_on).state;
  world->assets = mission.assets;
  world->scenario = mission.scenario;
  world->plan = mission.scenario.trajectory.plan;
  world->limits = limits_of(mission.scenario.trajectory);
  world->survey = std::make_unique<PileSurvey>(world->assets, world->pile, world->threads);
  if (mission.scenario.robots.empty()) {
    world->entry = find_entry(mission.scenario, *world->survey);
    world->survey->forget_voids();
  } else {
    enter_robots(request, mission, run, *world);
  }
  adapt(*world, request);
  if (!world->robots) check_entry(*world);

  run.progress.start("scene");
  // By hand there is no time for the reference; the saved mission keeps what was asked for.
  Scenario drawn = world->scenario;
  drawn.cameras.front().camera.colour = ColourSpec();
  const Scene scene = world->robots ? world->robots->build_scene(drawn)
                                    : build_scene(drawn, world->assets, world->pile);
  world->device = open_device(drawn.device, of.options.device, run.threads());
  world->renderer = prepare_renderer(scene, drawn.cameras.front().camera.colour, *world->device,
                                     {world->threads,
                                      [&](double fraction) {
                                        run.progress.update(fraction, "light");
                                        go_on();
                                      },
                                      {}});
  run.progress.finish("ready on " + world->device->info().name);
  return world;
}

}  // namespace rubble
