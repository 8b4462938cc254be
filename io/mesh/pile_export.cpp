#include "io/mesh/pile_export.h"

#include "io/mesh/stl_writer.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void write_stl_of(const std::string& path, const PileModel& model) {
  std::vector<MeshInstance> instances;
  for (const PileModel::Piece& piece : model.pieces)
    instances.push_back({model.types[piece.type].mesh, piece.scale, piece.world_from_body});
  write_stl(path, instances);
}

// A welded mesh has about half as many vertices as triangles; a number as text takes up to 12
// bytes.
constexpr double kFileBytes = 1000, kObjTriangle = 190, kGlbTriangle = 84;

const std::vector<MeshFormat> kFormats{
    {"stl",
     {"pile.stl"},
     false,
     write_stl_of,
     [](const PileModelSize& s) { return kFileBytes + 50 * s.triangles; }},
    {"ply",
     {"pile.ply"},
     false,
     write_ply,
     [](const PileModelSize& s) { return kFileBytes + (13 + 19) * s.triangles; }},
    {"obj",
     {"pile.mtl", "pile.obj"},
     false,
     write_obj,
     [](const PileModelSize& s) {
       return kFileBytes + kObjTriangle * s.triangles + 40 * s.pieces;
     }},
    {"glb",
     {"pile.glb"},
     false,
     write_glb,
     [](const PileModelSize& s) {
       return kFileBytes + kGlbTriangle * s.type_triangles + 320 * s.pieces + 2000 * s.types;
     }},
    {"sdf",
     {"sdf"},
     true,
     write_sdf,
     [](const PileModelSize& s) {
       return kFileBytes + kObjTriangle * s.type_triangles + 1100 * s.pieces + 4000;
     }},
};

}  // namespace

const std::vector<MeshFormat>& mesh_formats() { return kFormats; }

std::string join_mesh_formats(const std::string& last_word) {
  std::string text;
  for (std::size_t i = 0; i < kFormats.size(); ++i)
    text += (i == 0 ? "" : i + 1 == kFormats.size() ? last_word : ", ") + kFormats[i].name;
  return text;
}

const MeshFormat& find_mesh_format(const std::string& name) {
  for (const MeshFormat& format : kFormats)
    if (format.name == name) return format;
  Diagnostic diagnostic;
  diagnostic.message = "unknown export format";
  diagnostic.expected = "one of " + join_mesh_formats(", ");
  diagnostic.found = "`" + name + "`";
  throw InputError(diagnostic);
}

std::vector<std::string> export_pile(const PileModel& model, const std::string& name,
                                     const std::string& folder) {
  const MeshFormat& format = find_mesh_format(name);
  format.write(folder + "/" + format.leaves.back(), model);
  return format.leaves;
}

}  // namespace rubble
