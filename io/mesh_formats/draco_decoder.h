// Meshes that Draco compressed, as the extension KHR_draco_mesh_compression of glTF holds them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace rubble {

class DracoMesh {
 public:
  // Throws RunError with the library's reason.
  explicit DracoMesh(std::string_view bytes);
  ~DracoMesh();

  std::vector<std::array<std::uint32_t, 3>> triangles() const;
  // The values of an attribute by its unique number, `components` for each vertex; empty: there is none of so many.
  std::vector<double> values(std::uint32_t id, std::size_t components) const;

 private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
};

}  // namespace rubble
