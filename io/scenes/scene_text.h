// What the writers of scenes share: numbers, looks, and meshes as OBJ files beside the scene.
#pragma once

#include <initializer_list>
#include <set>
#include <string>
#include <vector>

#include "io/base/folder_writer.h"
#include "io/scenes/sim_scene.h"

namespace rubble {

// Numbers that read back to the same bits, with blanks between them.
std::string number_list(std::initializer_list<double> numbers);
std::string vector_text(const Vec3& v);                // "x y z"
std::string quaternion_text(const Quat& q);            // "w x y z"
std::string rpy_text(const Quat& q);                   // roll, pitch, yaw (REP 103)

// Limits of joints beyond this are none; unit: rad, m.
inline constexpr double kFreeLimit = 1e8;
// MuJoCo's and USD's cameras look along -Z, with X to the right.
inline constexpr Quat kBodyFromLens{0.5, 0.5, -0.5, -0.5};

// How a surface of the scene's meshes looks.
struct SceneLook {
  std::string name;      // of the surface; unique
  Vec3f colour;          // linear-light albedo; of the picture's too, where there is one
  float roughness = 0.9f, metalness = 0;
  std::string picture;   // name of its PNG file; empty: it has none
  std::string png;       // the bytes of that file
};
// Of all surfaces, by name. Surfaces without a name have the look "grey".
std::vector<SceneLook> list_looks(const ExportModel& model);
std::string surface_name(const TriangleMesh& mesh, std::size_t surface);
std::size_t count_surfaces(const TriangleMesh& mesh);
// sRGB code values, 0 to 1, with alpha: "0.5 0.5 0.5 1".
std::string srgb_text(const Vec3f& linear);

// One surface of a mesh as a mesh; empty where it has no triangle.
TriangleMesh take_surface(const TriangleMesh& mesh, std::size_t surface);

// Names of files for names of things, each unlike the others on file systems that do not tell case apart.
class FileNames {
 public:
  std::string add(const std::string& name);

 private:
  std::set<std::string> taken_;
};

// Meshes of the scene in the folder meshes/, as OBJ with materials.mtl and its pictures: by index into SimScene::meshes,
// and of convex parts by shape and hull. Paths are relative to the scene's folder.
struct SceneMeshFiles {
  std::vector<std::string> meshes, surfaces;
  std::vector<std::vector<std::string>> hulls;  // "" where a hull is a box
};
SceneMeshFiles write_mesh_files(const ExportModel& model, FolderWriter& files);
void write_pictures(const std::vector<SceneLook>& looks, FolderWriter& files);
std::string hull_obj(const Hull& hull, double scale = 1);
std::string mesh_obj(const std::string& name, const TriangleMesh& mesh);     // with materials.mtl
// Without a material; empty where it has fewer than four different corners.
std::string surface_obj(const std::string& name, const TriangleMesh& surface);

// What no simulator's format has a place for in one form: names, classes, numbers in the stream `instance`, masses and
// poses of all models. file_of: of a model; null: there is one file of all.
std::string scene_json(const ExportModel& model, const std::vector<std::string>* file_of_model = nullptr);

// "X" for names of things that a format wants as words: what is not a letter, a digit or an underscore becomes one.
std::string identifier(const std::string& name);
// Each unlike the others.
class Identifiers {
 public:
  std::string add(const std::string& name);

 private:
  std::set<std::string> taken_;
};

}  // namespace rubble
