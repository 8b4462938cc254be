#include "io/mesh/pile_export.h"

#include <filesystem>

#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void write_stl_of(const std::string& path, const PileModel& model) {
  std::vector<MeshInstance> instances;
  for (const PileModel::Piece& piece : model.pieces)
    instances.push_back({model.types[piece.type].mesh, piece.scale, piece.world_from_body});
  write_stl(path, instances);
}

}  // namespace

std::vector<std::string> export_formats() { return {"stl", "ply", "obj", "glb", "sdf"}; }

std::vector<std::string> export_pile(const PileModel& model, const std::string& format,
                                     const std::string& folder) {
  const std::string path = folder + "/pile." + format;
  if (format == "stl") return write_stl_of(path, model), std::vector<std::string>{"pile.stl"};
  if (format == "ply") return write_ply(path, model), std::vector<std::string>{"pile.ply"};
  if (format == "glb") return write_glb(path, model), std::vector<std::string>{"pile.glb"};
  if (format == "obj")
    return write_obj(path, model), std::vector<std::string>{"pile.mtl", "pile.obj"};
  if (format == "sdf") return write_sdf(folder + "/sdf", model), std::vector<std::string>{"sdf"};
  Diagnostic diagnostic;
  diagnostic.message = "unknown export format";
  diagnostic.expected = "one of stl, ply, obj, glb, sdf";
  diagnostic.found = "`" + format + "`";
  throw InputError(diagnostic);
}

}  // namespace rubble
