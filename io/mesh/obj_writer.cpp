#include "io/mesh/mesh_writers.h"

#include <algorithm>
#include <charconv>

#include "io/base/atomic_file.h"
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

// Of each corner v, v/vt, v//vn or v/vt/vn. place: number of the first corner's; 0: none.
void put_face(std::string& text, const std::array<std::uint32_t, 3>& v, const ObjCounts& before,
              const std::array<std::uint32_t, 3>* n, std::size_t place) {
  text += 'f';
  for (std::size_t i = 0; i < 3; ++i) {
    text += ' ' + std::to_string(before.positions + v[i] + 1);
    if (place > 0) text += '/' + std::to_string(place + i);
    if (n) text += (place > 0 ? "/" : "//") + std::to_string(before.normals + (*n)[i] + 1);
  }
  text += '\n';
}

void put_place(std::string& text, const PaintCorner& corner) {
  char number[32];
  text += "vt";
  for (const float x : {corner.u, corner.v}) {
    text += ' ';
    text.append(number, std::to_chars(number, number + sizeof number, x + 0.0f).ptr);
  }
  text += '\n';
}

// Whether each normal is that of its face, within a degree.
bool is_flat(const TriangleMesh& mesh) {
  constexpr float kCosine = 0.9998477f;
  for (const auto& t : mesh.triangles) {
    const Vec3f& a = mesh.positions[t[0]];
    const Vec3f area = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
    const float size = norm(area);
    for (const std::uint32_t v : t)
      if (dot(area, mesh.normals[v]) < kCosine * size) return false;
  }
  return true;
}

std::string make_mtl(const PileModel& model) {
  std::vector<std::string> names;
  for (const PileModel::Type& type : model.types)
    names.insert(names.end(), type.mesh->surface_names.begin(), type.mesh->surface_names.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string text = kComment;
  for (const std::string& name : names) text += mtl_text(name, model.colour_of(name));
  return text;
}

}  // namespace

// Faces of one surface together: a `usemtl` for each change would make thousands of groups.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, ObjContent content, ObjCounts& counts) {
  text += "o " + one_line(piece.name) + "\n";
  for (const Vec3f& p : welded.positions) put_vector(text, "v", world_position(piece, p));
  const bool looks = content == ObjContent::looks, with_normals = looks && !welded.normals.empty() && !is_flat(mesh);
  if (with_normals)
    for (const Vec3f& n : mesh.normals)
      put_vector(text, "vn", Vec3f(piece.world_from_body.rotation.rotate(Vec3(n))));
  const std::size_t surfaces = std::max<std::size_t>(1, mesh.surface_names.size());
  for (std::size_t s = 0; s < surfaces; ++s) {
    if (s < mesh.surface_names.size()) text += "usemtl " + one_line(mesh.surface_names[s]) + "\n";
    const SurfacePaint* const paint = mesh.paint_of(s);
    const bool placed = looks && paint && paint->albedo.side > 0;
    for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
      if (welded.surfaces[i] != s) continue;
      if (placed) {
        for (const PaintCorner& corner : mesh.paint_corners[welded.sources[i]]) put_place(text, corner);
        counts.places += 3;
      }
      put_face(text, welded.triangles[i], counts, with_normals ? &welded.normals[i] : nullptr, placed ? counts.places - 2 : 0);
    }
  }
  counts.positions += welded.positions.size();
  if (with_normals) counts.normals += mesh.normals.size();
}

std::string mtl_text(const std::string& name, const Vec3f& colour, const std::string& picture) {
  std::string text = "newmtl " + one_line(name) + "\n";
  put_vector(text, "Kd", colour);
  text += "Ks 0 0 0\nillum 1\n";
  if (!picture.empty()) text += "map_Kd " + one_line(picture) + "\n";
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
  ObjCounts counts;
  std::string text;
  for (const PileModel::Piece& piece : model.pieces) {
    text.clear();
    put_obj_object(text, piece, *model.types[piece.type].mesh, welded[piece.type], ObjContent::solid, counts);
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
