// The content of a mesh file in one form for all formats: meshes at their places in the file's frame, materials, images.
// The readers of io/mesh_formats fill it; io/import/mesh_join.h and io/import/mesh_paint.h make a TriangleMesh of it.
// All of them run in the child process of io/mesh/mesh_file.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Throws InputError. line: 1-based; 0: none.
[[noreturn]] void refuse_mesh(const std::string& path, const std::string& message, const std::string& hint = "",
                              int line = 0);

// Where a texture lies on a surface: uv' = offset + rotation * (scale * uv), with v downwards, as
// KHR_texture_transform of glTF defines it.
struct TexturePlace {
  unsigned uv_set = 0;
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  double rotation = 0;  // counter-clockwise; unit: rad

  bool moved() const {
    return offset != std::array<double, 2>{0, 0} || scale != std::array<double, 2>{1, 1} || rotation != 0;
  }
  bool operator==(const TexturePlace& b) const {
    return uv_set == b.uv_set && offset == b.offset && scale == b.scale && rotation == b.rotation;
  }
};

// Of surfaces to which a file gives no material: the name that packs know.
inline constexpr char kDefaultMaterial[] = "DefaultMaterial";

struct ImportedImage {
  std::string name;                          // as the file writes it
  std::shared_ptr<const std::string> bytes;  // of a PNG or JPEG inside the file; null: a file of this name
  std::string fault;                         // why it cannot be had, "is of raw texels"; empty: nothing known
};

struct ImportedTexture {
  int image = -1;  // index into ImportedScene::images; -1: none
  TexturePlace place;
};

struct ImportedMaterial {
  std::string name;
  Vec3f colour{1, 1, 1};  // linear-light albedo
  float opacity = 1;
  bool alpha_of_image = true;  // the fourth channel of the image means transparency
  std::optional<float> roughness, metalness;
  Vec3f specular{0, 0, 0};  // of a Phong highlight, with its exponent
  float exponent = 0;
  ImportedTexture albedo, normals, roughness_map, metalness_map;
  std::vector<std::string> left_out;  // what of it is not drawn, a clause each: "height images are not drawn"
};

// Triangles of one material and one object.
struct ImportedMesh {
  int material = -1;            // index into ImportedScene::materials; -1: none
  int object = 0;               // meshes of one object share a number; objects are numbered in order of the file
  std::vector<Vec3> positions;  // in the frame and unit of the file
  std::vector<Vec3f> normals;   // of any length; empty, or one per position
  std::vector<Vec3f> colours;   // as written; empty, or one per position
  std::vector<std::vector<std::array<float, 2>>> uv_sets;  // v upwards; each empty, or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;     // counter-clockwise seen from outside
};

enum class FileUp { x, y, z };

struct ImportedScene {
  std::vector<ImportedMesh> meshes;
  std::vector<ImportedMaterial> materials;
  std::vector<ImportedImage> images;
  bool linear_colours = false;   // colours of vertices are linear light (glTF); otherwise sRGB
  std::optional<FileUp> up;      // what the file itself states (COLLADA)
  std::vector<std::string> notes;  // what of its shape is left out or repaired, a clause each

  void note(const std::string& text);  // once
};

// A mesh of this material and object at the end of the scene; the last one if it is of both.
ImportedMesh& mesh_for(ImportedScene& scene, int material, int object);

}  // namespace rubble
