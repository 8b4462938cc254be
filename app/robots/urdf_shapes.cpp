#include "app/robots/urdf_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/assets/asset_materials.h"
#include "app/assets/convex_parts.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr int kFacets = 32, kSpherePoints = 96;
constexpr float kPaintReflectance = 0.04f, kPaintRoughness = 0.6f;  // of what has a colour in the file; our choice

// Golden-angle spiral. With a length the two halves are that far apart, along Z. unit: m
ConvexPart make_ball(double radius, double length = 0) {
  ConvexPart part;
  const double golden = portable::kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kSpherePoints; ++i) {
    const double z = 1 - 2 * (i + 0.5) / kSpherePoints, level = std::sqrt(1 - z * z);
    const auto [s, c] = portable::sincos(golden * i);
    part.points.push_back(Vec3{level * c, level * s, z} * radius);
    if (length > 0) part.points.back().z += z > 0 ? length / 2 : -length / 2;
  }
  return part;
}

// Along Z.
ConvexPart make_cylinder(double radius, double length) {
  ConvexPart part = make_wheel(radius, length, kFacets);
  for (Vec3& p : part.points) p = {p.x, -p.z, p.y};
  return part;
}

// A robot has dozens of links, each with its mesh: fewer parts and a coarser measure than for an asset, which may be a
// thousand pieces of a pile. Other programs take one hull for a link.
DecomposeOptions link_options() {
  DecomposeOptions options;
  options.max_parts = 8, options.most_parts = 12;
  options.resolution = 48;
  return options;
}

// A scale that mirrors turns triangles inside out: they are turned back.
void turn_triangles(TriangleMesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (auto& corners : mesh.paint_corners) std::swap(corners[1], corners[2]);
}

// warnings: gets once what of the file's shape is left out.
TriangleMesh load_scaled(const UrdfGeometry& g, MeshImporter& importer, std::vector<std::string>& warnings) {
  MeshUnits units;
  units.heed_stated_axis = false;
  TriangleMesh mesh = importer.load_mesh(g.file, units);
  for (const std::string& note : importer.notes().shape) {
    const std::string warning = g.file + ": " + note;
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
  }
  for (Vec3f& p : mesh.positions)
    p = {float(p.x * g.scale.x), float(p.y * g.scale.y), float(p.z * g.scale.z)};
  mesh.normals.clear();  // an uneven scale turns them
  if (g.scale.x * g.scale.y * g.scale.z < 0) turn_triangles(mesh);
  const Aabb box = mesh.bounds();
  const Vec3 far = max(box.max, -box.min);
  if (const double most = std::max({far.x, far.y, far.z}); !(most <= kUrdfFarthest))
    throw InputError({g.file, 0, "scale", "makes the mesh too large", "vertices within 10000 m", brief_text(most) + " m", ""});
  return mesh;
}

// All of it, over the colours of its file, as RViz does.
void paint(const Vec3f& colour, TriangleMesh& mesh) {
  SurfacePaint paint;
  paint.colour = colour, paint.reflectance = kPaintReflectance, paint.roughness = kPaintRoughness;
  Sha256 hash;
  for (const float x : {colour.x, colour.y, colour.z}) hash.add(&x, sizeof x);
  paint.sha256 = hash.hex();
  mesh.surface_names = {"material"};
  mesh.surfaces.assign(mesh.triangles.size(), 0);
  mesh.paints = {std::make_shared<const SurfacePaint>(std::move(paint))};
  mesh.paint_corners.assign(mesh.triangles.size(), {});
}

// By surface of the mesh: which it is of the link's looks. The first of those is what has no colours of its own.
std::vector<std::uint8_t> add_surfaces(const TriangleMesh& mesh, const std::string& plain, TriangleMesh& looks) {
  if (looks.surface_names.empty()) looks.surface_names = {plain};
  std::vector<std::uint8_t> out(std::max<std::size_t>(1, mesh.surface_names.size()), 0);
  for (std::size_t s = 0; s < mesh.paints.size() && looks.surface_names.size() < 256; ++s) {
    if (!mesh.paints[s]) continue;
    out[s] = std::uint8_t(looks.surface_names.size());
    looks.paints.resize(looks.surface_names.size());
    looks.surface_names.push_back(mesh.surface_names[s]);
    looks.paints.push_back(mesh.paints[s]);
  }
  return out;
}

TriangleMesh make_looks(const UrdfGeometry& g, MeshImporter& importer, std::vector<std::string>& warnings) {
  if (g.kind == UrdfGeometry::Kind::mesh) {
    TriangleMesh mesh = load_scaled(g, importer, warnings);
    const bool painted = std::any_of(mesh.paints.begin(), mesh.paints.end(), [](const auto& paint) { return paint != nullptr; });
    if (!g.colour && painted)
      for (const std::string& note : importer.notes().looks) warnings.push_back(g.file + ": " + note);
    return mesh;
  }
  RobotLink solid;
  solid.parts = make_urdf_parts(g, importer, warnings);
  return make_link_mesh(solid, "");
}

}  // namespace

std::vector<ConvexPart> make_urdf_parts(const UrdfGeometry& g, MeshImporter& importer,
                                        std::vector<std::string>& warnings) {
  switch (g.kind) {
    case UrdfGeometry::Kind::box:
      return {make_box(g.size)};
    case UrdfGeometry::Kind::cylinder:
      return {make_cylinder(g.radius, g.length)};
    case UrdfGeometry::Kind::capsule:
      return {make_ball(g.radius, g.length)};
    case UrdfGeometry::Kind::sphere:
      return {make_ball(g.radius)};
    case UrdfGeometry::Kind::mesh:
      break;
  }
  return decompose_cached(load_scaled(g, importer, warnings), DiskCache(DiskCache::usual_folder()), link_options()).parts;
}

void add_urdf_looks(const UrdfGeometry& g, const Pose& body_from_link, RobotModel& model, std::size_t body,
                    MeshImporter& importer, std::vector<std::string>& warnings) {
  TriangleMesh mesh = make_looks(g, importer, warnings);
  if (g.colour) paint(*g.colour, mesh);
  const Pose body_from_mesh = body_from_link * g.link_from_geometry;
  TriangleMesh& looks = model.links[body].looks;
  const std::string plain = choose_link_surface(model, body);
  choose_surfaces(mesh, [&plain](const std::string&, const SurfacePaint* own) { return own ? std::string() : plain; });
  const std::vector<std::uint8_t> surfaces = add_surfaces(mesh, plain, looks);
  const auto first = std::uint32_t(looks.positions.size());
  for (const Vec3f& p : mesh.positions) looks.positions.push_back(Vec3f(body_from_mesh * Vec3(p)));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    looks.triangles.push_back({first + v[0], first + v[1], first + v[2]});
    looks.surfaces.push_back(mesh.surfaces.empty() ? std::uint8_t(0) : surfaces[mesh.surfaces[t]]);
    if (mesh.paint_corners.empty() && looks.paint_corners.empty()) continue;
    looks.paint_corners.resize(looks.triangles.size());
    if (!mesh.paint_corners.empty()) looks.paint_corners.back() = mesh.paint_corners[t];
  }
}

}  // namespace rubble
