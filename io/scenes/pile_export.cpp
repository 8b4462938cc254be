#include "io/scenes/pile_export.h"

#include "io/mesh/stl_writer.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void write_stl_of(const std::string& path, const ExportModel& model) {
  std::vector<MeshInstance> instances;
  for (const PileModel::Piece& piece : model.pile.pieces)
    instances.push_back({model.pile.types[piece.type].mesh, piece.scale, piece.world_from_body});
  write_stl(path, instances);
}
void write_ply_of(const std::string& path, const ExportModel& model) { write_ply(path, model.pile); }
void write_obj_of(const std::string& path, const ExportModel& model) { write_obj(path, model.pile); }
void write_glb_of(const std::string& path, const ExportModel& model) { write_glb(path, model.pile); }

// A welded mesh has about half as many vertices as triangles; a number as text takes up to 12
// bytes. A piece has a dozen convex parts at most on the average, each with a dozen corners.
constexpr double kFileBytes = 1000, kObjTriangle = 90, kGlbTriangle = 150, kSceneTriangle = 300, kUsdTriangle = 500,
                 kPictureBytes = 160e3, kScenePictures = 20;

double estimate_scene(const PileModelSize& s, double piece, double triangle) {
  return kScenePictures * kPictureBytes + triangle * s.type_triangles + piece * s.pieces + 20000 * s.types;
}

const std::vector<MeshFormat> kFormats{
    {"stl", "STL", {"pile.stl"}, false, write_stl_of,
     [](const PileModelSize& s) { return kFileBytes + 50 * s.triangles; }},
    {"ply", "PLY", {"pile.ply"}, false, write_ply_of,
     [](const PileModelSize& s) { return kFileBytes + (13 + 19) * s.triangles; }},
    {"obj", "OBJ", {"pile.mtl", "pile.obj"}, false, write_obj_of,
     [](const PileModelSize& s) { return kFileBytes + kObjTriangle * s.triangles + 40 * s.pieces; }},
    {"glb", "glTF", {"pile.glb"}, false, write_glb_of,
     [](const PileModelSize& s) { return kFileBytes + kGlbTriangle * s.type_triangles + 320 * s.pieces + 2000 * s.types + kScenePictures * kPictureBytes; }},
    {"sdf", "SDF", {"sdf"}, true, write_sdf,
     [](const PileModelSize& s) { return estimate_scene(s, 16000, kSceneTriangle); }, sdf_limits},
    {"mjcf", "MuJoCo's XML", {"mjcf"}, true, write_mjcf,
     [](const PileModelSize& s) { return estimate_scene(s, 16000, kSceneTriangle); }, mjcf_limits},
    {"usd", "OpenUSD", {"usd"}, true, write_usd,
     [](const PileModelSize& s) { return estimate_scene(s, 30000, kUsdTriangle); }, usd_limits},
    {"urdf", "URDF", {"urdf"}, true, write_urdf,
     [](const PileModelSize& s) { return estimate_scene(s, 16000, kSceneTriangle); }, urdf_limits},
};

bool ends(const std::string& name, const std::string& end) {
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

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

bool is_scene_file(const std::string& name) {
  for (const char* whole : {"pile.sdf", "pile.xml", "pile.usda", "fixed.urdf", "scene.json"})
    if (name == whole) return true;
  const std::size_t slash = name.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash);
  if (folder == "meshes") return ends(name, ".obj") || ends(name, ".mtl") || ends(name, ".png") || ends(name, ".hfield");
  if (folder == "models" || folder == "robots") return ends(name, ".urdf");
  return folder.compare(0, 7, "robots/") == 0 && ends(folder, "_meshes") &&
         (ends(name, ".obj") || ends(name, ".mtl") || ends(name, ".stl"));
}

std::vector<std::string> export_pile(const ExportModel& model, const std::string& name,
                                     const std::string& folder) {
  const MeshFormat& format = find_mesh_format(name);
  format.write(folder + "/" + format.leaves.back(), model);
  return format.leaves;
}

}  // namespace rubble
