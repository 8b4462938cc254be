// The colours of a mesh's file: assimp's materials as paints. In the child that reads the mesh, as all of assimp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/mesh.h"

struct aiMaterial;
struct aiMesh;
struct aiScene;

namespace rubble {

inline constexpr int kLargestPaint = 2048;  // of an image's side; larger ones are made smaller; unit: texel

class MeshPaints {
 public:
  // path: of the mesh; images are looked for beside it.
  MeshPaints(const aiScene& scene, const std::string& path);

  // Whether the file says anything of colours: an image, colours of vertices, or materials that are not all of
  // the same grey. Nearly every exporter writes one grey.
  bool any() const { return any_; }
  // Null where any() is false.
  std::shared_ptr<const SurfacePaint> of(const aiMesh& mesh);
  PaintCorner corner(const aiMesh& mesh, unsigned vertex) const;
  // What of all this could not be drawn: "the image wood.bmp is neither PNG nor JPEG".
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Image;
  SurfacePaint read(const aiMaterial& material);
  void read_gloss(const aiMaterial& material, SurfacePaint& paint) const;
  const Image* find(const aiMaterial& material, int type);
  Image load(const std::string& name);
  void note_left_out(const aiMaterial& material);
  void note(const std::string& text);

  const aiScene& scene_;
  std::string folder_;
  bool any_ = false;
  bool linear_corners_ = false;  // colours of vertices are linear light, as glTF's; otherwise sRGB
  std::map<unsigned, std::shared_ptr<const SurfacePaint>> paints_;  // by material
  std::map<std::string, std::shared_ptr<const Image>> images_;      // by the name in the file
  std::vector<std::string> notes_;
};

}  // namespace rubble
