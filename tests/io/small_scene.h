// A small mesh, and a scene of a pile for tests: every piece a model, with the hull of its mesh.
#pragma once

#include "io/scenes/pile_export.h"
#include "kernel/geometry/shape.h"

namespace rubble::test {

inline TriangleMesh make_flat_tetrahedron() {  // without normals, of one surface
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}, {0, 0, 0.6f}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  mesh.surfaces = {0, 0, 0, 0};
  mesh.surface_names = {"rebar"};
  return mesh;
}

// free: numbers of pieces that may move, with a density of 2400 kg/m3.
inline ExportModel make_scene(const PileModel& pile, const std::vector<std::size_t>& free = {}) {
  ExportModel model;
  model.pile = pile;
  std::vector<VolumeProperties> volumes;
  for (const PileModel::Type& type : pile.types) {
    ConvexPart part;
    for (const Vec3f& p : type.mesh->positions) part.points.push_back(Vec3(p));
    volumes.push_back(calc_volume_properties(part));
    model.sim.meshes.push_back({type.name, type.mesh});
    model.sim.shapes.push_back({type.name, {calc_hull(part.points)}});
  }
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PileModel::Piece& piece = pile.pieces[i];
    const VolumeProperties& volume = volumes[piece.type];
    const double s = piece.scale, density = 2400;
    SimLink link;
    link.name = piece.name, link.label = pile.types[piece.type].name, link.number = piece.number;
    link.world_from_link = piece.world_from_body;
    link.mass = density * volume.volume * s * s * s;
    link.centre_of_mass = volume.centre_of_mass * s;
    link.inertia = volume.inertia * (density * s * s * s * s * s);
    SimPart part;
    part.mesh = part.shape = int(piece.type), part.scale = s, part.friction = 0.65;
    link.parts = {part};
    SimModel one;
    one.name = piece.name, one.fixed = true;
    for (const std::size_t f : free) one.fixed = one.fixed && f != i;
    one.links = {link};
    model.sim.models.push_back(one);
  }
  return model;
}

}  // namespace rubble::test
