#include "app/assets/assets_tree.h"

#include <algorithm>
#include <cstdio>

#include "app/assets/assemblies.h"
#include "kernel/collision/gjk.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

constexpr float kTouching = 1e-4f;    // links this near as designed start with a push; unit: m
constexpr double kFarFromJoint = 0.1;  // unit: m

using Points = std::vector<Vec3f>;

std::vector<Points> parts_in_whole(const AssemblyLink& link, const PieceType& type) {
  std::vector<Points> parts;
  for (const ConvexPart& part : type.parts) {
    parts.emplace_back();
    for (const Vec3& p : part.points)
      parts.back().push_back(Vec3f(link.assembly_from_link * (p * link.scale)));
  }
  return parts;
}

// Between two sets of convex parts; 0 where they overlap. unit: m
float calc_gap(const std::vector<Points>& a, const std::vector<Points>& b) {
  float least = 1e9f;
  for (const Points& p : a) {
    for (const Points& q : b) {
      GjkCache cache;
      const GjkResult r = calc_distance({p.data(), int(p.size())}, {q.data(), int(q.size())}, {},
                                        1e9f, cache);
      least = std::min(least, r.kind == GjkResult::Kind::overlapping ? 0.0f : r.distance);
    }
  }
  return least;
}

std::string centimetres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f cm", 100 * length);
  return text;
}

std::string link_name(const Asset& asset, std::size_t i) {
  return "link " + std::to_string(i + 1) + " (" + asset.links[i].asset + ")";
}

}  // namespace

TriangleMesh merge_links(const AssemblyType& assembly, const AssetLibrary& library) {
  TriangleMesh whole;
  for (const AssemblyLink& link : assembly.links) {
    const TriangleMesh& mesh = library.meshes[std::size_t(link.type)]->levels.front();
    const auto first = std::uint32_t(whole.positions.size());
    const auto surface = int(whole.surface_names.size());
    for (const Vec3f& p : mesh.positions)
      whole.positions.push_back(Vec3f(link.assembly_from_link * (Vec3(p) * link.scale)));
    for (const Vec3f& n : mesh.normals)
      whole.normals.push_back(Vec3f(link.assembly_from_link.rotation.rotate(Vec3(n))));
    for (const auto& t : mesh.triangles)
      whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (const auto s : mesh.surfaces)
      whole.surfaces.push_back(decltype(whole.surfaces)::value_type(s + surface));
    for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
      whole.surface_names.push_back(mesh.surface_names[s]);
      whole.paints.push_back(s < mesh.paints.size() ? mesh.paints[s] : nullptr);
    }
    whole.paint_corners.insert(whole.paint_corners.end(), mesh.paint_corners.begin(), mesh.paint_corners.end());
    whole.paint_corners.resize(whole.triangles.size());
  }
  return whole;
}

double calc_mass(const AssemblyType& assembly, const AssetLibrary& library) {
  double mass = 0;
  for (const AssemblyLink& link : assembly.links) {
    const PieceType& type = library.types[std::size_t(link.type)];
    mass += compile_shape(type, type.name).volume.volume * type.density * link.scale * link.scale *
            link.scale;
  }
  return mass;
}

TreeReport check_tree(const Asset& asset, const AssetLibrary& library) {
  TreeReport report;
  report.name = asset.name;
  const AssemblyType assembly = make_assembly(asset, library);
  report.links = assembly.links.size();
  report.joints = assembly.joints.size();
  report.mass = calc_mass(assembly, library);
  const Aabb box = merge_links(assembly, library).bounds();
  report.size = box.max - box.min;
  std::vector<std::vector<Points>> parts;
  for (const AssemblyLink& link : assembly.links) {
    parts.push_back(parts_in_whole(link, library.types[std::size_t(link.type)]));
    report.parts += parts.back().size();
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool joined = asset.links[i].on == int(k) && !asset.links[i].joint.collide;
      if (!joined && calc_gap(parts[i], parts[k]) < kTouching)
        report.errors.push_back(link_name(asset, i) + " overlaps " + link_name(asset, k) +
                                " as designed: move them apart, or join them");
    }
    if (asset.links[i].on < 0) continue;
    const std::vector<Points> joint{
        {Vec3f(asset.links[i].joint.assembly_from_joint.translation)}};
    for (const std::size_t link : {i, std::size_t(asset.links[i].on)}) {
      const double gap = calc_gap(parts[link], joint);
      if (gap > kFarFromJoint)
        report.warnings.push_back("the joint of " + link_name(asset, i) + " is " + centimetres(gap) +
                                  " away from " + link_name(asset, link));
    }
  }
  return report;
}

}  // namespace rubble
