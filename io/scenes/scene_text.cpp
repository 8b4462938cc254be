#include "io/scenes/scene_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/base/srgb.h"
#include "io/mesh/mesh_writers.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kObjComment[] = "# Rubble: metres, right-handed, Z up\n";
constexpr char kGrey[] = "grey";

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

SceneLook describe_look(const PileModel& pile, const TriangleMesh& mesh, std::size_t surface) {
  SceneLook look;
  look.name = surface_name(mesh, surface);
  look.colour = pile.colour_of(look.name);
  const SurfacePaint* paint = mesh.paint_of(surface);
  if (!paint) return look;
  look.colour = paint->colour, look.roughness = paint->roughness, look.metalness = paint->metalness;
  look.png = make_glb_images(*paint).base_colour;
  if (!look.png.empty()) look.picture = file_name_of(look.name) + ".png";
  return look;
}

}  // namespace

std::string number_list(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + exact_text(number + 0.0);
  return text;
}
std::string vector_text(const Vec3& v) { return number_list({v.x, v.y, v.z}); }
std::string quaternion_text(const Quat& q) { return number_list({q.w, q.x, q.y, q.z}); }
std::string rpy_text(const Quat& q) { return vector_text(portable::rpy_from_quat(q)); }

std::string surface_name(const TriangleMesh& mesh, std::size_t surface) {
  const bool named = surface < mesh.surface_names.size() && !mesh.surface_names[surface].empty();
  return named ? mesh.surface_names[surface] : kGrey;
}

std::size_t count_surfaces(const TriangleMesh& mesh) { return std::max<std::size_t>(1, mesh.surface_names.size()); }

std::vector<SceneLook> list_looks(const ExportModel& model) {
  std::vector<SceneLook> looks;
  for (const SimMesh& mesh : model.sim.meshes)
    for (std::size_t s = 0; s < count_surfaces(*mesh.mesh); ++s) {
      const std::string name = surface_name(*mesh.mesh, s);
      const auto at = std::lower_bound(looks.begin(), looks.end(), name,
                                       [](const SceneLook& look, const std::string& n) { return look.name < n; });
      if (at == looks.end() || at->name != name) looks.insert(at, describe_look(model.pile, *mesh.mesh, s));
    }
  return looks;
}

std::string srgb_text(const Vec3f& linear) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += fixed_text(srgb_from_linear(std::clamp(double(linear[i]), 0.0, 1.0)), 4) + " ";
  return text + "1";
}

TriangleMesh take_surface(const TriangleMesh& mesh, std::size_t surface) {
  TriangleMesh taken;
  std::vector<std::int64_t> number(mesh.positions.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if ((mesh.surfaces.empty() ? 0 : mesh.surfaces[t]) != surface) continue;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (number[v] < 0) {
        number[v] = std::int64_t(taken.positions.size());
        taken.positions.push_back(mesh.positions[v]);
        if (!mesh.normals.empty()) taken.normals.push_back(mesh.normals[v]);
      }
      corners[k] = std::uint32_t(number[v]);
    }
    taken.triangles.push_back(corners);
    taken.surfaces.push_back(0);
    if (mesh.paint_of(surface)) taken.paint_corners.push_back(mesh.paint_corners[t]);
  }
  if (mesh.paint_of(surface)) taken.paints = {mesh.paints[surface]};
  return taken;
}

std::string FileNames::add(const std::string& name) {
  const std::string plain = file_name_of(name);
  std::string tried = plain;
  for (int i = 2; !taken_.insert(lower_case(tried)).second; ++i) tried = plain + "_" + std::to_string(i);
  return tried;
}

std::string identifier(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9', letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (text.empty() && !letter && c != '_') text += '_';
    text += digit || letter ? c : '_';
  }
  return text.empty() ? "_" : text;
}

std::string Identifiers::add(const std::string& name) {
  const std::string plain = identifier(name);
  std::string tried = plain;
  for (int i = 2; !taken_.insert(tried).second; ++i) tried = plain + "_" + std::to_string(i);
  return tried;
}

std::string hull_obj(const Hull& hull, double scale) {
  std::string text = kObjComment;
  for (const Vec3& p : hull.points) text += "v " + vector_text(p * scale) + "\n";
  for (const std::array<int, 3>& t : calc_hull_triangles(hull))
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return text;
}

std::string mesh_obj(const std::string& name, const TriangleMesh& mesh) {
  PileModel::Piece piece;
  piece.name = name;
  std::string text = std::string(kObjComment) + "mtllib materials.mtl\n";
  ObjCounts counts;
  put_obj_object(text, piece, mesh, weld(mesh), ObjContent::looks, counts);
  return text;
}

std::string surface_obj(const std::string& name, const TriangleMesh& surface) {
  const WeldedMesh welded = weld(surface);
  if (welded.positions.size() < 4 || welded.triangles.empty()) return "";
  PileModel::Piece piece;
  piece.name = name;
  std::string text = kObjComment;
  ObjCounts counts;
  put_obj_object(text, piece, surface, welded, ObjContent::looks, counts);
  return text;
}

void write_pictures(const std::vector<SceneLook>& looks, FolderWriter& files) {
  for (const SceneLook& look : looks)
    if (!look.picture.empty()) files.write("meshes/" + look.picture, look.png);
}

SceneMeshFiles write_mesh_files(const ExportModel& model, FolderWriter& files) {
  SceneMeshFiles written;
  FileNames names;
  const auto write = [&](const std::string& name, const TriangleMesh& mesh) {
    const std::string file = "meshes/" + names.add(name) + ".obj";
    files.write(file, mesh_obj(name, mesh));
    return file;
  };
  const std::vector<SceneLook> looks = list_looks(model);
  std::string library = kObjComment;
  for (const SceneLook& look : looks) library += mtl_text(look.name, look.colour, look.picture);
  files.write("meshes/materials.mtl", library);
  write_pictures(looks, files);
  for (const SimMesh& mesh : model.sim.meshes) written.meshes.push_back(write(mesh.name, *mesh.mesh));
  for (const SimSurface& surface : model.sim.surfaces) written.surfaces.push_back(write(surface.name + "_surface", *surface.mesh));
  for (const SimShape& shape : model.sim.shapes) {
    written.hulls.emplace_back();
    for (std::size_t k = 0; k < shape.hulls.size(); ++k) {
      std::string file;
      if (!find_box(shape.hulls[k])) {
        file = "meshes/" + names.add(shape.name + "_part_" + std::to_string(k)) + ".obj";
        files.write(file, hull_obj(shape.hulls[k]));
      }
      written.hulls.back().push_back(file);
    }
  }
  return written;
}

std::string scene_json(const ExportModel& model, const std::vector<std::string>* file_of_model) {
  const auto numbers = [](std::initializer_list<double> list) { return Json(std::vector<double>(list)); };
  const auto put_pose = [&](Json& to, const Pose& pose) {
    const Vec3& t = pose.translation;
    const Quat& q = pose.rotation;
    to["position_m"] = numbers({t.x, t.y, t.z});
    to["quaternion_wxyz"] = numbers({q.w, q.x, q.y, q.z});
  };
  Json models = Json::array(), cameras = Json::array();
  for (std::size_t i = 0; i < model.sim.models.size(); ++i) {
    const SimModel& m = model.sim.models[i];
    Json one{{"name", printable(m.name)}, {"fixed", m.fixed}, {"robot", m.robot != nullptr}};
    if (file_of_model) one["file"] = (*file_of_model)[i];
    Json links = Json::array(), joints = Json::array();
    for (const SimLink& link : m.links) {
      Json l{{"name", printable(link.name)}, {"label", printable(link.label)}, {"instance", link.number}, {"mass_kg", link.mass}};
      put_pose(l, link.world_from_link);
      links.push_back(std::move(l));
    }
    for (const SimJoint& joint : m.joints)
      if (!joint.loop && joint.kind != JointKind::weld)
        joints.push_back({{"name", printable(joint.name)}, {"position", joint.position}});
    one["links"] = links;
    if (!joints.empty()) one["joints"] = joints;
    models.push_back(std::move(one));
  }
  for (const SimCamera& camera : model.sim.cameras) {
    Json one{{"name", printable(camera.name)}};
    if (camera.model >= 0) {
      const SimModel& carrier = model.sim.models[std::size_t(camera.model)];
      one["model"] = printable(carrier.name);
      one["link"] = printable(carrier.links[std::size_t(camera.link)].name);
    }
    put_pose(one, camera.carrier_from_camera);
    one["width"] = camera.width, one["height"] = camera.height;
    one["fx"] = camera.fx, one["fy"] = camera.fy, one["cx"] = camera.cx, one["cy"] = camera.cy;
    cameras.push_back(std::move(one));
  }
  return Json{{"format", "rubble scene 1"}, {"gravity_m_s2", model.pile.gravity}, {"models", models}, {"cameras", cameras}}
             .dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

}  // namespace rubble
