// An SDF 1.9 world for Gazebo Sim: http://sdformat.org/spec?ver=1.9
#include "io/base/folder_writer.h"
#include "io/base/number_text.h"
#include "io/base/xml_text.h"
#include "io/mesh/obj_writer.h"
#include "io/mesh/pile_export.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr char kBegin[] = R"(<?xml version="1.0"?>
<sdf version="1.9">
  <world name="rubble">
    <gravity>0 0 -%</gravity>
    <light name="sun" type="directional">
      <pose>0 0 20 0 0 0</pose>
      <diffuse>0.9 0.9 0.9 1</diffuse>
      <direction>-0.5 0.3 -0.8</direction>
      <cast_shadows>true</cast_shadows>
    </light>
    <model name="ground">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <geometry><plane><normal>0 0 1</normal><size>200 200</size></plane></geometry>
        </collision>
        <visual name="visual">
          <geometry><plane><normal>0 0 1</normal><size>200 200</size></plane></geometry>
        </visual>
      </link>
    </model>
)";

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + exact_text(value);
  return text;
}

std::string model_element(const PileModel::Piece& piece, const std::string& mesh) {
  const Vec3& t = piece.world_from_body.translation;
  // Roll, pitch and yaw: readers other than Gazebo's take any six or seven numbers as these.
  const Vec3 rpy = portable::rpy_from_quat(piece.world_from_body.rotation);
  const std::string geometry =
      "          <geometry><mesh><uri>meshes/" + xml_text(file_name_of(mesh)) + ".obj</uri><scale>" +
      numbers({piece.scale, piece.scale, piece.scale}) + "</scale></mesh></geometry>\n";
  return "    <model name=\"" + xml_text(piece.name) +
         "\">\n      <static>true</static>\n      <pose>" +
         numbers({t.x, t.y, t.z, rpy.x, rpy.y, rpy.z}) +
         "</pose>\n      <link name=\"link\">\n        <collision name=\"collision\">\n" +
         geometry + "        </collision>\n        <visual name=\"visual\">\n" + geometry +
         "        </visual>\n      </link>\n    </model>\n";
}

// The mesh of a type, in the frame of its body.
std::string mesh_obj(const PileModel& model, std::uint32_t type) {
  PileModel::Piece piece;
  piece.type = type;
  piece.name = model.types[type].name;
  const TriangleMesh& mesh = *model.types[type].mesh;
  std::string text = "# Rubble: metres, right-handed, Z up\nmtllib materials.mtl\n";
  std::size_t vertices = 0, normals = 0;
  put_obj_object(text, piece, mesh, weld(mesh), vertices, normals);
  return text;
}

}  // namespace

bool is_sdf_file(const std::string& name) {
  const auto ends = [&name](const std::string& end) {
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  return name == "pile.sdf" || (name.compare(0, 7, "meshes/") == 0 && (ends(".obj") || ends(".mtl")));
}

void write_sdf(const std::string& folder, const PileModel& model) {
  FolderWriter files(folder, {"meshes"}, 1);
  std::string world = kBegin;
  world.replace(world.find('%'), 1, exact_text(model.gravity));
  for (const PileModel::Piece& piece : model.pieces)
    world += model_element(piece, model.types[piece.type].name);
  world += "  </world>\n</sdf>\n";
  files.write("pile.sdf", world);
  files.write("meshes/materials.mtl", make_mtl(model));
  for (std::uint32_t type = 0; type < model.types.size(); ++type)
    files.write("meshes/" + file_name_of(model.types[type].name) + ".obj", mesh_obj(model, type));
  files.finish();
}

}  // namespace rubble
