// The colours of a mesh's file as paints.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/import/imported_scene.h"
#include "kernel/base/mesh.h"

namespace rubble {

inline constexpr int kLargestPaint = 2048;  // of an image's side; larger ones are made smaller; unit: texel

class MeshPaints {
 public:
  // path: of the mesh; images are looked for beside it.
  MeshPaints(const ImportedScene& scene, const std::string& path);

  // Whether the file says anything of colours: an image, colours of vertices, or materials that are not all of
  // the same grey. Nearly every exporter writes one grey.
  bool any() const { return any_; }
  // Null where any() is false. material: -1: none.
  std::shared_ptr<const SurfacePaint> of(int material);
  PaintCorner corner(const ImportedMesh& mesh, std::uint32_t vertex);
  // What of all this could not be drawn: "the image wood.bmp is neither PNG nor JPEG".
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Image;
  SurfacePaint read(const ImportedMaterial& material);
  void read_gloss(const ImportedMaterial& material, SurfacePaint& paint) const;
  const Image* find(const ImportedMaterial& material, const ImportedTexture& texture, const char* what);
  Image load(const ImportedImage& image);
  void note(const std::string& text);

  const ImportedScene& scene_;
  std::string mesh_path_, folder_;
  bool any_ = false;
  std::map<int, std::shared_ptr<const SurfacePaint>> paints_;  // by material
  std::map<int, std::shared_ptr<const Image>> images_;         // by index in the scene
  std::vector<std::string> notes_;
};

}  // namespace rubble
