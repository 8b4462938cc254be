// OpenUSD as text, with the schemas of UsdPhysics: https://openusd.org/release/api/usd_physics_page_front.html
#include <algorithm>
#include <cmath>
#include <map>

#include "io/scenes/scene_text.h"
#include "io/scenes/scene_writers.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr double kDegree = 180 / portable::kPi;  // angles of UsdPhysics are in degrees, gains of angular drives per degree
constexpr double kAperture = 20.955;             // USD's own, of a camera; unit: a tenth of a scene unit

std::string tuple(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "(" : ", ") + exact_text(number + 0.0);
  return text + ")";
}
std::string tuple(const Vec3& v) { return tuple({v.x, v.y, v.z}); }
std::string tuple(const Quat& q) { return tuple({q.w, q.x, q.y, q.z}); }
std::string tuple(const Vec3f& v) {
  char number[32];
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i == 0 ? "(" : ", ") + std::string(number, std::to_chars(number, number + sizeof number, v[i] + 0.0f).ptr);
  return text + ")";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(one_line(text))) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string transform(const Pose& pose, const std::string& indent, double scale = 1) {
  std::string text = indent + "double3 xformOp:translate = " + tuple(pose.translation) + "\n" + indent +
                     "quatd xformOp:orient = " + tuple(pose.rotation) + "\n";
  if (scale != 1) text += indent + "double3 xformOp:scale = " + tuple({scale, scale, scale}) + "\n";
  return text + indent + "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"" +
         (scale != 1 ? ", \"xformOp:scale\"" : "") + "]\n";
}

// The shortest rotation that takes Z to the axis.
Quat from_z_to(const Vec3& axis) {
  if (axis.z < -0.999999) return {0, 1, 0, 0};
  return normalized(Quat{1 + axis.z, -axis.y, axis.x, 0});
}


class UsdBuilder {
 public:
  explicit UsdBuilder(const ExportModel& model) : model_(model), looks_(list_looks(model)) {}

  std::string build() {
    for (const SceneLook& look : looks_) look_names_.push_back(materials_.add(look.name));
    std::string text =
        "#usda 1.0\n(\n    defaultPrim = \"World\"\n    kilogramsPerUnit = 1\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n" +
        prototypes() + "def Xform \"World\"\n{\n" + fixtures() + looks_text() + frictions_text();
    std::string surfaces;
    for (const SimSurface& surface : model_.sim.surfaces) surfaces += surface_text(surface);
    text += surfaces;
    for (std::size_t i = 0; i < model_.sim.models.size(); ++i) text += model_text(int(i));
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model < 0) text += camera_text(camera, names_.add(camera.name), "    ");
    return text + "}\n";
  }

 private:
  std::string fixtures() {
    for (const char* taken : {"physics", "sun", "ground", "looks", "frictions"}) names_.add(taken);
    return "    def PhysicsScene \"physics\"\n    {\n        vector3f physics:gravityDirection = (0, 0, -1)\n"
           "        float physics:gravityMagnitude = " +
           exact_text(model_.pile.gravity) +
           "\n    }\n\n    def DistantLight \"sun\"\n    {\n        float inputs:intensity = 3000\n"
           "        float3 xformOp:rotateXYZ = (-35, -20, 0)\n        uniform token[] xformOpOrder = [\"xformOp:rotateXYZ\"]\n    }\n\n"
           "    def Plane \"ground\" (\n        prepend apiSchemas = [\"PhysicsCollisionAPI\"]\n    )\n    {\n"
           "        uniform token axis = \"Z\"\n        float3[] extent = [(-100, -100, 0), (100, 100, 0)]\n        double length = 200\n        double width = 200\n"
           "        color3f[] primvars:displayColor = [(0.15, 0.14, 0.12)]\n    }\n\n";
  }

  std::string looks_text() const {
    std::string text = "    def Scope \"looks\"\n    {\n";
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      const SceneLook& look = looks_[i];
      const std::string path = "/World/looks/" + look_names_[i];
      text += "        def Material \"" + look_names_[i] + "\"\n        {\n            token outputs:surface.connect = <" + path +
              "/shader.outputs:surface>\n\n            def Shader \"shader\"\n            {\n"
              "                uniform token info:id = \"UsdPreviewSurface\"\n                color3f inputs:diffuseColor" +
              (look.picture.empty() ? " = " + tuple(look.colour) : ".connect = <" + path + "/picture.outputs:rgb>") +
              "\n                float inputs:metallic = " + exact_text(double(look.metalness)) +
              "\n                float inputs:roughness = " + exact_text(double(look.roughness)) +
              "\n                token outputs:surface\n            }\n";
      if (!look.picture.empty())
        text += "\n            def Shader \"picture\"\n            {\n                uniform token info:id = \"UsdUVTexture\"\n"
                "                asset inputs:file = @./meshes/" +
                look.picture +
                "@\n                float4 inputs:scale = " + tuple({double(look.colour.x), double(look.colour.y), double(look.colour.z), 1}) +
                "\n                token inputs:sourceColorSpace = \"sRGB\"\n                float2 inputs:st.connect = <" + path +
                "/places.outputs:result>\n                token inputs:wrapS = \"repeat\"\n                token inputs:wrapT = \"repeat\"\n"
                "                float3 outputs:rgb\n            }\n\n            def Shader \"places\"\n            {\n"
                "                uniform token info:id = \"UsdPrimvarReader_float2\"\n                string inputs:varname = \"st\"\n"
                "                float2 outputs:result\n            }\n";
      text += "        }\n";
    }
    return text + "    }\n\n";
  }

  // A material of each friction that is used.
  std::string frictions_text() {
    const auto add = [&](double friction) { frictions_.try_emplace(friction, int(frictions_.size())); };
    for (const SimModel& model : model_.sim.models)
      for (const SimLink& link : model.links)
        for (const SimPart& part : link.parts)
          if (part.shape >= 0) add(part.friction);
    for (const SimSurface& surface : model_.sim.surfaces) add(surface.friction);
    std::string text = "    def Scope \"frictions\"\n    {\n";
    for (const auto& [friction, number] : frictions_)
      text += "        def Material \"friction_" + std::to_string(number) +
              "\" (\n            prepend apiSchemas = [\"PhysicsMaterialAPI\"]\n        )\n        {\n"
              "            float physics:dynamicFriction = " +
              exact_text(friction) + "\n            float physics:restitution = 0\n            float physics:staticFriction = " +
              exact_text(friction) + "\n        }\n";
    return text + "    }\n\n";
  }

  // Meshes as classes, which prims of the world inherit as instances: each is in the file once.
  std::string prototypes() {
    std::string text;
    Identifiers names;
    for (const char* taken : {"World"}) names.add(taken);
    for (const SimMesh& mesh : model_.sim.meshes) {
      prototypes_.push_back(names.add("mesh_" + mesh.name));
      text += "class Xform \"" + prototypes_.back() + "\"\n{\n" + mesh_text("mesh", *mesh.mesh, "    ", "", "") + "}\n\n";
    }
    return text;
  }

  // schemas: applied beside that of materials; more: attributes.
  std::string mesh_text(const std::string& name, const TriangleMesh& mesh, const std::string& indent, const std::string& schemas,
                        const std::string& more) const {
    const WeldedMesh welded = weld(mesh);
    const std::string inner = indent + "    ";
    std::string points, counts, indices, normals, places;
    bool placed = false;
    for (std::size_t s = 0; s < count_surfaces(mesh); ++s) {
      const SurfacePaint* const paint = mesh.paint_of(s);
      placed = placed || (paint && paint->albedo.side > 0);
    }
    const auto put = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
    for (const Vec3f& p : welded.positions) put(points, tuple(p));
    for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
      put(counts, "3");
      for (std::size_t k = 0; k < 3; ++k) {
        put(indices, std::to_string(welded.triangles[t][k]));
        if (!welded.normals.empty()) put(normals, tuple(mesh.normals[welded.normals[t][k]]));
        if (!placed) continue;
        const PaintCorner corner = mesh.paint_corners.empty() ? PaintCorner() : mesh.paint_corners[welded.sources[t]][k];
        put(places, tuple({double(corner.u), double(corner.v)}));
      }
    }
    Vec3f low = welded.positions.front(), high = low;
    for (const Vec3f& p : welded.positions) low = min(low, p), high = max(high, p);
    std::string text = indent + "def Mesh \"" + name + "\"" + (schemas.empty() ? "" : " (\n" + inner + "prepend apiSchemas = [" + schemas + "]\n" + indent + ")") +
                       "\n" + indent + "{\n" + inner + "uniform token subdivisionScheme = \"none\"\n" + inner + "float3[] extent = [" + tuple(low) + ", " +
                       tuple(high) + "]\n" + inner + "point3f[] points = [" + points + "]\n" + inner + "int[] faceVertexCounts = [" +
                       counts + "]\n" + inner + "int[] faceVertexIndices = [" + indices + "]\n";
    if (!normals.empty())
      text += inner + "normal3f[] normals = [" + normals + "] (\n" + inner + "    interpolation = \"faceVarying\"\n" + inner + ")\n";
    if (placed)
      text += inner + "texCoord2f[] primvars:st = [" + places + "] (\n" + inner + "    interpolation = \"faceVarying\"\n" + inner + ")\n";
    const std::string subsets = subsets_text(mesh, welded, inner);
    if (!subsets.empty()) text += inner + "uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n";
    return text + more + subsets + indent + "}\n";
  }

  std::string subsets_text(const TriangleMesh& mesh, const WeldedMesh& welded, const std::string& indent) const {
    std::string text;
    Identifiers names;
    for (std::size_t s = 0; s < count_surfaces(mesh); ++s) {
      std::string indices;
      for (std::size_t t = 0; t < welded.triangles.size(); ++t)
        if (welded.surfaces[t] == s) indices += (indices.empty() ? "" : ", ") + std::to_string(t);
      const auto look = std::lower_bound(looks_.begin(), looks_.end(), surface_name(mesh, s),
                                         [](const SceneLook& a, const std::string& n) { return a.name < n; });
      if (indices.empty() || look == looks_.end() || look->name != surface_name(mesh, s)) continue;
      text += "\n" + indent + "def GeomSubset \"" + names.add(look->name) + "\" (\n" + indent +
              "    prepend apiSchemas = [\"MaterialBindingAPI\"]\n" + indent + ")\n" + indent + "{\n" + indent +
              "    uniform token elementType = \"face\"\n" + indent + "    uniform token familyName = \"materialBind\"\n" + indent +
              "    int[] indices = [" + indices + "]\n" + indent + "    rel material:binding = </World/looks/" +
              look_names_[std::size_t(look - looks_.begin())] + ">\n" + indent + "}\n";
    }
    return text;
  }

  std::string surface_text(const SimSurface& surface) {
    const std::string inner = "            ";
    return "    def Xform \"" + names_.add(surface.name + "_surface") + "\"\n    {\n" +
           transform(surface.world_from_mesh, "        ", surface.scale) +
           mesh_text("collision", *surface.mesh, "        ",
                     "\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\", \"MaterialBindingAPI\"",
                     inner + "uniform token physics:approximation = \"none\"\n" + inner + "uniform token purpose = \"guide\"\n" +
                         friction_text(surface.friction, inner)) +
           "    }\n\n";
  }

  std::string friction_text(double friction, const std::string& indent) const {
    return indent + "rel material:binding:physics = </World/frictions/friction_" + std::to_string(frictions_.at(friction)) + ">\n";
  }

  std::string model_text(int index) {
    const SimModel& model = model_.sim.models[std::size_t(index)];
    const std::string name = names_.add(model.name);
    if (model.links.size() == 1) return link_text(index, 0, name, "    ", !model.fixed, "") + "\n";
    Identifiers inside;
    std::vector<std::string> paths;
    // Newton refuses joints that belong to no articulation.
    std::string text = "    def Xform \"" + name + "\" (\n        prepend apiSchemas = [\"PhysicsArticulationRootAPI\"]\n    )\n    {\n";
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const std::string link = inside.add(model.links[i].name);
      paths.push_back("/World/" + name + "/" + link);
      text += link_text(index, int(i), link, "        ", true, "");
    }
    if (model.fixed)
      text += "        def PhysicsFixedJoint \"" + inside.add("fixed_root") + "\"\n        {\n            rel physics:body1 = <" + paths[0] +
              ">\n            point3f physics:localPos0 = " + tuple(model.links[0].world_from_link.translation) +
              "\n            quatf physics:localRot0 = " + tuple(model.links[0].world_from_link.rotation) + "\n        }\n";
    for (const SimJoint& joint : model.joints) text += joint_text(joint, inside.add(joint.name), paths);
    return text + "    }\n\n";
  }

  std::string link_text(int model_index, int index, const std::string& name, const std::string& indent, bool moves,
                        const std::string& more) {
    const SimModel& model = model_.sim.models[std::size_t(model_index)];
    const SimLink& link = model.links[std::size_t(index)];
    const std::string inner = indent + "    ";
    std::string text = indent + "def Xform \"" + name + "\" (\n" + inner + "prepend apiSchemas = [" +
                       (moves ? "\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\", " : "") + "\"SemanticsLabelsAPI:class\"]\n" + indent + ")\n" + indent +
                       "{\n" + transform(link.world_from_link, inner) + inner + "token[] semantics:labels:class = [" + quoted(link.label) + "]\n";
    if (link.number >= 0) text += inner + "custom int rubble:instance = " + std::to_string(link.number) + "\n";
    if (moves) {
      const PrincipalInertia inertia = calc_principal_inertia(link.inertia);
      text += inner + "float physics:mass = " + exact_text(link.mass) + "\n" + inner + "point3f physics:centerOfMass = " +
              tuple(link.centre_of_mass) + "\n" + inner + "float3 physics:diagonalInertia = " + tuple(inertia.moments) + "\n" + inner +
              "quatf physics:principalAxes = " + tuple(inertia.link_from_principal) + "\n";
    }
    text += more;
    Identifiers names;
    for (const SimPart& part : link.parts) text += part_text(part, names, inner);
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model == model_index && camera.link == index) text += camera_text(camera, names.add(camera.name), inner);
    return text + indent + "}\n";
  }

  std::string part_text(const SimPart& part, Identifiers& names, const std::string& indent) const {
    const std::string inner = indent + "    ";
    std::string text;
    if (part.mesh >= 0)
      text += "\n" + indent + "def \"" + names.add("visual") + "\" (\n" + inner + "inherits = </" + prototypes_[std::size_t(part.mesh)] + ">\n" +
              inner + "instanceable = true\n" + indent + ")\n" + indent + "{\n" + transform(part.link_from_part, inner, part.scale) + indent + "}\n";
    if (part.shape < 0) return text;
    const SimShape& shape = model_.sim.shapes[std::size_t(part.shape)];
    for (const Hull& hull : shape.hulls) text += hull_text(hull, part, names.add("collision"), indent);
    return text;
  }

  std::string hull_text(const Hull& hull, const SimPart& part, const std::string& name, const std::string& indent) const {
    const std::string inner = indent + "    ";
    const auto head = [&](const char* type, const char* more) {
      return "\n" + indent + "def " + type + " \"" + name + "\" (\n" + inner + "prepend apiSchemas = [\"PhysicsCollisionAPI\", " + more +
             "\"MaterialBindingAPI\"]\n" + indent + ")\n" + indent + "{\n" + inner + "uniform token purpose = \"guide\"\n" +
             friction_text(part.friction, inner);
    };
    if (const auto box = find_box(hull)) {
      Pose at = box->shape_from_box;
      at.translation *= part.scale;
      at = part.link_from_part * at;
      const Vec3 size = box->size * part.scale;
      return head("Cube", "") + inner + "double size = 1\n" + inner + "float3[] extent = [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]\n" + inner + "double3 xformOp:translate = " + tuple(at.translation) + "\n" +
             inner + "quatd xformOp:orient = " + tuple(at.rotation) + "\n" + inner + "double3 xformOp:scale = " + tuple(size) + "\n" + inner +
             "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", \"xformOp:scale\"]\n" + indent + "}\n";
    }
    std::string points, counts, indices;
    const auto put = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
    Vec3f low(hull.points.front() * part.scale), high = low;
    for (const Vec3& p : hull.points) {
      const Vec3f at(p * part.scale);
      low = min(low, at), high = max(high, at);
      put(points, tuple(at));
    }
    for (const std::array<int, 3>& t : calc_hull_triangles(hull)) {
      put(counts, "3");
      for (const int v : t) put(indices, std::to_string(v));
    }
    return head("Mesh", "\"PhysicsMeshCollisionAPI\", ") + inner + "uniform token physics:approximation = \"convexHull\"\n" + inner +
           "uniform token subdivisionScheme = \"none\"\n" + inner + "float3[] extent = [" + tuple(low) + ", " + tuple(high) + "]\n" + inner +
           "point3f[] points = [" + points + "]\n" + inner + "int[] faceVertexCounts = [" + counts + "]\n" + inner +
           "int[] faceVertexIndices = [" + indices + "]\n" + transform(part.link_from_part, inner) + indent + "}\n";
  }

  // The axis of the joint is Z of frames of its own.
  static std::string joint_text(const SimJoint& joint, const std::string& name, const std::vector<std::string>& paths) {
    const bool hinge = joint.kind == JointKind::hinge, slider = joint.kind == JointKind::slider, ball = joint.kind == JointKind::ball;
    const char* type = hinge ? "PhysicsRevoluteJoint" : slider ? "PhysicsPrismaticJoint" : ball ? "PhysicsSphericalJoint" : "PhysicsFixedJoint";
    const Quat turn = hinge || slider ? from_z_to(joint.axis) : Quat();
    const std::string inner = "            ";
    const bool driven = joint.drive != SimDrive::none || joint.stiffness > 0 || joint.damping > 0;
    const std::string drive = slider ? "linear" : "angular";
    std::string text = std::string("        def ") + type + " \"" + name + "\"";
    if (driven && (hinge || slider)) text += " (\n" + inner + "prepend apiSchemas = [\"PhysicsDriveAPI:" + drive + "\"]\n        )";
    text += "\n        {\n" + inner + "rel physics:body0 = <" + paths[std::size_t(joint.parent)] + ">\n" + inner + "rel physics:body1 = <" +
            paths[std::size_t(joint.child)] + ">\n";
    const auto frame = [&](const char* side, const Pose& pose) {
      text += inner + "point3f physics:localPos" + side + " = " + tuple(pose.translation) + "\n" + inner + "quatf physics:localRot" + side +
              " = " + tuple(pose.rotation * turn) + "\n";
    };
    frame("0", joint.parent_from_joint);
    frame("1", joint.child_from_joint);
    if (joint.loop) text += inner + "bool physics:excludeFromArticulation = 1\n";
    const double unit = slider ? 1 : kDegree;
    if (hinge || slider || ball) text += inner + "uniform token physics:axis = \"Z\"\n";
    if (hinge || slider) {
      if (joint.lower > -kFreeLimit) text += inner + "float physics:lowerLimit = " + exact_text(joint.lower * unit) + "\n";
      if (joint.upper < kFreeLimit) text += inner + "float physics:upperLimit = " + exact_text(joint.upper * unit) + "\n";
    }
    if (ball && joint.upper < kFreeLimit)
      for (const char* cone : {"0", "1"})
        text += inner + "float physics:coneAngle" + cone + "Limit = " + exact_text(joint.upper * kDegree) + "\n";
    if (driven && (hinge || slider)) {
      const bool motor = joint.drive != SimDrive::none;
      const double stiffness = joint.drive == SimDrive::position ? joint.drive_stiffness : motor ? 0 : joint.stiffness;
      const double damping = motor ? joint.drive_damping + joint.damping : joint.damping;
      const std::string at = inner + "float drive:" + drive + ":physics:";
      text += at + "damping = " + exact_text(damping / unit) + "\n" + at + "stiffness = " + exact_text(stiffness / unit) + "\n" + at +
              "targetPosition = " + exact_text((motor ? joint.position : joint.rest) * unit) + "\n";
      if (motor && joint.effort > 0) text += at + "maxForce = " + exact_text(joint.effort) + "\n";
    }
    return text + "        }\n";
  }

  static std::string camera_text(const SimCamera& camera, const std::string& name, const std::string& indent) {
    const std::string inner = indent + "    ";
    const Pose pose{camera.carrier_from_camera.rotation * kBodyFromLens, camera.carrier_from_camera.translation};
    const double pixel = kAperture / camera.width;
    return "\n" + indent + "def Camera \"" + name + "\"\n" + indent + "{\n" + inner + "float2 clippingRange = (0.02, 1000)\n" + inner +
           "float focalLength = " + exact_text(camera.fx * pixel) + "\n" + inner + "float horizontalAperture = " + exact_text(kAperture) + "\n" +
           inner + "float verticalAperture = " + exact_text(camera.height * pixel * camera.fx / camera.fy) + "\n" + inner +
           "float horizontalApertureOffset = " + exact_text((0.5 * (camera.width - 1) - camera.cx) * pixel) + "\n" + inner +
           "float verticalApertureOffset = " + exact_text((camera.cy - 0.5 * (camera.height - 1)) * pixel * camera.fx / camera.fy) + "\n" +
           transform(pose, inner) + indent + "}\n";
  }

  const ExportModel& model_;
  std::vector<SceneLook> looks_;
  std::vector<std::string> look_names_, prototypes_;
  Identifiers materials_, names_;
  std::map<double, int> frictions_;
};

}  // namespace

void write_usd(const std::string& folder, const ExportModel& model) {
  FolderWriter files(folder, {"meshes"}, 1);
  write_pictures(list_looks(model), files);
  files.write("pile.usda", UsdBuilder(model).build());
  files.write("scene.json", scene_json(model));
  files.finish();
}

}  // namespace rubble
