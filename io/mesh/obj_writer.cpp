#include "io/mesh/obj_writer.h"

#include <algorithm>
#include <charconv>

#include "io/base/atomic_file.h"
#include "io/mesh/pile_export.h"
#include "kernel/base/system/output_files.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr char kComment[] = "# Rubble: metres, right-handed, Z up\n";

// The shortest text that reads back to the same float.
void put_vector(std::string& text, const char* keyword, const Vec3f& v) {
  char number[32];
  text += keyword;
  for (int i = 0; i < 3; ++i) {
    text += ' ';
    text.append(number, std::to_chars(number, number + sizeof number, v[i] + 0.0f).ptr);
  }
  text += '\n';
}

void put_face(std::string& text, const std::array<std::uint32_t, 3>& v, std::size_t vertices,
              const std::array<std::uint32_t, 3>* n, std::size_t normals) {
  text += 'f';
  for (std::size_t i = 0; i < 3; ++i) {
    text += ' ' + std::to_string(vertices + v[i] + 1);
    if (n) text += "//" + std::to_string(normals + (*n)[i] + 1);
  }
  text += '\n';
}

}  // namespace

// Faces of one surface together: a `usemtl` for each change would make thousands of groups.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, std::size_t& vertices, std::size_t& normals) {
  text += "o " + one_line(piece.name) + "\n";
  for (const Vec3f& p : welded.positions) put_vector(text, "v", world_position(piece, p));
  for (const Vec3f& n : mesh.normals)
    put_vector(text, "vn", Vec3f(piece.world_from_body.rotation.rotate(Vec3(n))));
  const std::size_t surfaces = std::max<std::size_t>(1, mesh.surface_names.size());
  for (std::size_t s = 0; s < surfaces; ++s) {
    if (s < mesh.surface_names.size()) text += "usemtl " + one_line(mesh.surface_names[s]) + "\n";
    for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
      if (welded.surfaces[i] != s) continue;
      put_face(text, welded.triangles[i], vertices,
               welded.normals.empty() ? nullptr : &welded.normals[i], normals);
    }
  }
  vertices += welded.positions.size();
  normals += mesh.normals.size();
}

std::string make_mtl(const PileModel& model) {
  std::vector<std::string> names;
  for (const PileModel::Type& type : model.types)
    names.insert(names.end(), type.mesh->surface_names.begin(), type.mesh->surface_names.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string text = kComment;
  for (const std::string& name : names) {
    text += "newmtl " + one_line(name) + "\n";
    put_vector(text, "Kd", model.colour_of(name));
    text += "Ks 0 0 0\nillum 1\n";
  }
  return text;
}

void write_obj(const std::string& path, const PileModel& model) {
  const std::string stem = path.substr(0, path.size() - 4);
  const std::string library = stem.substr(stem.find_last_of('/') + 1) + ".mtl";
  std::vector<WeldedMesh> welded;
  for (const PileModel::Type& type : model.types) welded.push_back(weld(*type.mesh));
  AtomicFile file(path), materials(stem + ".mtl");
  materials.write(make_mtl(model));
  file.write(kComment + ("mtllib " + library + "\n"));
  std::size_t vertices = 0, normals = 0;
  std::string text;
  for (const PileModel::Piece& piece : model.pieces) {
    text.clear();
    put_obj_object(text, piece, *model.types[piece.type].mesh, welded[piece.type], vertices,
                   normals);
    file.write(text);
  }
  materials.commit();
  try {
    file.commit();
  } catch (...) {  // neither is of use without the other
    remove_output_file(stem + ".mtl");
    throw;
  }
}

}  // namespace rubble
