// `rubble assets show`: every asset of a pack on one sheet, drawn by the renderer of the frames.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <numeric>

#include "app/assets/assemblies.h"
#include "app/assets/asset_library.h"
#include "app/assets/assets_tree.h"
#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/provenance/earlier_files.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "app/support/run_request.h"
#include "io/image/picture_sheet.h"
#include "kernel/base/portable_math.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/shape.h"
#include "render/renderer.h"

namespace rubble {
namespace {

constexpr int kColumns = 6;
constexpr double kAspect = 9.0 / 7;  // of a tile
constexpr int kOversample = 2;
constexpr double kFovDeg = 24;
// Assets whose sizes differ no more than this share a scene: its shadows are then fine enough.
constexpr double kSizeRange = 2;

struct Exhibit {
  std::string name;
  std::shared_ptr<const SceneMesh> mesh;
  double mass = 0;    // unit: kg
  Vec3 centre, size;  // of its box, in its frame; unit: m
  double radius = 0;  // unit: m
  double x = 0;       // where it stands, in a row along X; unit: m
};

Exhibit make_exhibit(const std::string& name, std::shared_ptr<const SceneMesh> mesh, double mass) {
  Exhibit e;
  e.name = name;
  e.mesh = std::move(mesh);
  e.mass = mass;
  const Aabb box = e.mesh->levels.front().bounds();
  e.centre = (box.min + box.max) * 0.5;
  e.size = box.max - box.min;
  e.radius = 0.5 * norm(e.size);
  return e;
}

// Looks that are easily told apart, one after another for the parts of a piece.
constexpr const char* kPartLooks[] = {"brick", "plaster", "timber", "car_paint", "concrete_fracture"};

// The convex parts that a piece collides with, as a mesh: each in a look of its own.
std::shared_ptr<const SceneMesh> draw_parts(const PieceType& type) {
  TriangleMesh mesh;
  for (const char* look : kPartLooks) mesh.surface_names.emplace_back(look);
  for (std::size_t i = 0; i < type.parts.size(); ++i) {
    const Hull hull = calc_hull(type.parts[i].points);
    const auto look = std::uint8_t(i % std::size(kPartLooks));
    for (const std::vector<int>& face : hull.faces) {
      const auto first = std::uint32_t(mesh.positions.size());
      for (const int corner : face) mesh.positions.emplace_back(hull.points[std::size_t(corner)]);
      for (std::uint32_t k = 2; k < face.size(); ++k) {
        mesh.triangles.push_back({first, first + k - 1, first + k});
        mesh.surfaces.push_back(look);
      }
    }
  }
  auto scene = std::make_shared<SceneMesh>();
  scene->levels.push_back(std::move(mesh));
  return scene;
}

// collision: what it collides with instead of what it looks like.
Exhibit load_exhibit(const Asset& asset, AssetLibrary& library, bool collision) {
  if (asset.links.empty()) {
    LoadedAsset loaded = load_asset(asset, *library.importer);
    if (collision) loaded.mesh = draw_parts(loaded.type);
    library.types.push_back(loaded.type);
    library.meshes.push_back(loaded.mesh);
    const double volume = compile_shape(loaded.type, asset.name).volume.volume;
    return make_exhibit(asset.name, loaded.mesh, volume * loaded.type.density);
  }
  const AssemblyType assembly = make_assembly(asset, library);
  auto mesh = std::make_shared<SceneMesh>();
  mesh->levels.push_back(merge_links(assembly, library));
  return make_exhibit(asset.name, std::move(mesh), calc_mass(assembly, library));
}

// From the front left, a little above, as near as shows the whole box.
Pose view_of(const Exhibit& e) {
  constexpr double kYaw = 1.05, kPitch = 0.46;  // unit: rad
  const Quat turn = portable::quat_from_rpy(0, kPitch, kYaw);
  const Vec3 middle{e.x, 0, 0.5 * e.size.z};
  const double half_fov = 0.5 * kFovDeg * portable::kPi / 180;
  const double up = 0.88 * portable::sin(half_fov) / portable::cos(half_fov);
  const double aside = up * kAspect;
  double away = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{(i & 1 ? 0.5 : -0.5) * e.size.x, (i & 2 ? 0.5 : -0.5) * e.size.y,
                      (i & 4 ? 0.5 : -0.5) * e.size.z};
    const Vec3 seen = turn.conjugate().rotate(corner);  // X forward, Y left, Z up
    away = std::max({away, std::fabs(seen.y) / aside - seen.x, std::fabs(seen.z) / up - seen.x});
  }
  return {turn, middle - turn.rotate(Vec3{away, 0, 0})};
}

RgbImage shrink(const Frame& frame) {
  const int width = frame.intrinsics.width, height = frame.intrinsics.height;
  RgbImage image{width / kOversample, height / kOversample, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = 0; v < kOversample; ++v) {
          for (int u = 0; u < kOversample; ++u) {
            const int at = (y * kOversample + v) * width + x * kOversample + u;
            sum += frame.rgb[std::size_t(3 * at + c)];
          }
        }
        image.rgb.push_back(std::uint8_t(sum / (kOversample * kOversample)));
      }
    }
  }
  return image;
}

std::string note_of(const Exhibit& e) {
  char text[120];
  std::snprintf(text, sizeof text, "%.2f x %.2f x %.2f m  %.*f kg", e.size.x, e.size.y, e.size.z,
                e.mass < 10 ? 1 : 0, e.mass);
  return text;
}

// Stands them in a row, so far apart that none is in another's picture.
Scene stage(std::vector<Exhibit*>& row) {
  Scene scene;
  double x = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    Exhibit& e = *row[i];
    x += i ? 4 * (e.radius + row[i - 1]->radius) : 0;
    e.x = x;
  }
  for (Exhibit* e : row) {
    e->x -= x / 2;
    scene.meshes.push_back(e->mesh);
    const Vec3 at{e->x - e->centre.x, -e->centre.y, 0.5 * e->size.z - e->centre.z};
    scene.instances.push_back({std::uint32_t(scene.instances.size()), 1, {Quat{}, at},
                               std::uint32_t(scene.instances.size())});
  }
  scene.light.rpy_deg = {0, 48, 100};
  scene.light.intensity = 70;
  scene.lamp.on = false;
  return scene;
}

void draw_row(Device& device, std::vector<Exhibit*> row, std::vector<SheetTile>& tiles,
              const std::vector<Exhibit>& all, int tile, int threads) {
  RenderOptions options;
  options.threads = threads;
  const Scene scene = stage(row);
  Intrinsics k;
  k.width = tile * kOversample, k.height = int(tile / kAspect) * kOversample;
  k.fx = k.fy = 0.5 * k.height / portable::sin(0.5 * kFovDeg * portable::kPi / 180) *
                portable::cos(0.5 * kFovDeg * portable::kPi / 180);
  k.cx = 0.5 * (k.width - 1), k.cy = 0.5 * (k.height - 1);
  Renderer renderer(device, scene, options);
  for (Exhibit* e : row) {
    Frame frame;
    for (int i = 0; i < 3; ++i) frame = renderer.render(view_of(*e), k, i, 1000000000LL * (i + 1));
    tiles[std::size_t(e - all.data())] = {shrink(frame), e->name, note_of(*e)};
  }
}

struct AssetsShowRequest {
  std::string pack, out;   // as of `assets check`; --out; empty: NAME.png
  int tile = 288;          // --tile; unit: pixel
  bool collision = false;  // --collision
  RunOptions options;      // --device, --threads, --quiet
};

ExitCode show_pack(const AssetsShowRequest& request) {
  const std::vector<Material> materials = load_materials(bundled_assets_folder() + "/materials.lua");
  const AssetPack pack = load_asset_pack(find_pack(request.pack), materials);
  const std::string path = request.out.empty() ? pack.name + ".png" : request.out;
  check_picture_name(path);
  refuse_recorded_file(path, "--out");
  RunContext context(request.options);
  Progress& progress = context.progress;
  progress.start("assets");
  std::vector<Exhibit> exhibits;
  AssetLibrary library;
  for (const bool articulated : {false, true}) {  // these are made of the others
    for (const Asset& asset : pack.assets) {
      if (asset.links.empty() != articulated) exhibits.push_back(load_exhibit(asset, library, request.collision));
    }
  }
  progress.finish(std::to_string(exhibits.size()) + " loaded");

  std::vector<std::size_t> order(exhibits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return exhibits[a].radius < exhibits[b].radius;
  });
  progress.start("render");
  const std::unique_ptr<Device> device = open_device(request.options.device, context.threads());
  std::vector<SheetTile> tiles(exhibits.size());
  for (std::size_t i = 0; i < order.size();) {
    std::vector<Exhibit*> row;
    const double smallest = exhibits[order[i]].radius;
    while (i < order.size() && exhibits[order[i]].radius <= kSizeRange * smallest) {
      row.push_back(&exhibits[order[i++]]);
    }
    draw_row(*device, row, tiles, exhibits, request.tile, context.threads());
    progress.update(double(i) / double(order.size()), std::to_string(i) + " of " +
                                                          std::to_string(order.size()));
  }
  progress.finish(std::to_string(tiles.size()) + " pictures");
  write_picture_sheet(path, "pack " + pack.name + ", " + std::to_string(tiles.size()) +
                                (request.collision ? " assets: the parts that collide" : " assets"),
                      tiles, kColumns);
  print_out("%s\n", path.c_str());
  return ExitCode::done;
}

Action declare_assets_show(CommandLine& line) {
  const auto request = std::make_shared<AssetsShowRequest>();
  line.add("pack", request->pack, "A folder with a pack.lua, or the name of a bundled pack").required().metavar("PACK");
  line.add("--out", request->out, "Output picture, .png or .jpg")
      .shows_default_text("NAME.png")
      .metavar("FILE");
  line.add("--tile", request->tile, "Width of the picture of one asset, in pixels")
      .shows_default()
      .between(64, 1024);
  line.add_flag("--collision", request->collision,
                "Draw the convex collision parts, each with a look of its own");
  add_run_options(line, request->options);
  return [request] { return show_pack(*request); };
}

}  // namespace

Command assets_show_command() {
  return {"assets", "show", "Draw every asset of a pack on one sheet", declare_assets_show};
}

}  // namespace rubble
