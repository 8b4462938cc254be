// A settled pile in formats of other programs: meshes (io/mesh/mesh_writers.h), and scenes for simulators
// (io/scenes/scene_writers.h). Metres and right-handed everywhere; Z up but for glTF.
//
//   stl   binary; triangles alone
//   ply, obj, glb: see mesh_writers.h
//   sdf   a folder: pile.sdf, an SDF 1.9 world for Gazebo and Drake, and meshes/
//   mjcf  a folder: pile.xml for MuJoCo, and meshes/
//   usd   a folder: pile.usda with the physics of UsdPhysics, and meshes/ with pictures
//   urdf  a folder: fixed.urdf, models/, robots/, meshes/
// Each folder has scene.json: names, classes, numbers, masses, poses, cameras.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_writers.h"
#include "io/scenes/scene_writers.h"

namespace rubble {

// What a format's size depends on. A mesh counts once for each piece that has it in `triangles`,
// and once at all in `type_triangles`.
struct PileModelSize {
  double pieces = 0, triangles = 0;      // counts
  double types = 0, type_triangles = 0;  // counts
};

// A format, complete: what writes it, what it leaves, and how large that gets at most.
struct MeshFormat {
  std::string name;                 // "obj": of --format and outputs.meshes
  std::string title;                // "MuJoCo's XML"
  std::vector<std::string> leaves;  // files in the output folder, or one folder
  bool is_folder = false;           // true: `leaves` is one folder, with a scene for simulators
  void (*write)(const std::string& path, const ExportModel& model);      // path: of the last of `leaves`
  double (*estimate)(const PileModelSize& size);                         // unit: byte
  std::vector<std::string> (*limits)(const SimScene& scene) = nullptr;  // what of it the format cannot say
};

// Every format. docs/development/contributing.md says how to add one.
const std::vector<MeshFormat>& mesh_formats();

// Their names joined by commas and a last word: "stl, ply, obj, glb or sdf".
std::string join_mesh_formats(const std::string& last_word);

// Throws InputError for a name that is no format's.
const MeshFormat& find_mesh_format(const std::string& name);

// Whether an export may have written this file of the folder of a scene. name: relative to that folder.
bool is_scene_file(const std::string& name);

// Writes FOLDER/pile.stl, and so on. Returns the names of what was written, relative to the folder.
// Throws InputError for an unknown format, RunError when it cannot be written.
std::vector<std::string> export_pile(const ExportModel& model, const std::string& format,
                                     const std::string& folder);

}  // namespace rubble
