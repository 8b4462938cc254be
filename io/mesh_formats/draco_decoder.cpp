#include "io/mesh_formats/draco_decoder.h"

#include <draco/compression/decode.h>

#include "kernel/base/error.h"

namespace rubble {

struct DracoMesh::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(std::string_view bytes) : decoded_(std::make_unique<Decoded>()) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) throw RunError("Draco cannot decode it: " + result.status().error_msg_string());
  decoded_->mesh = std::move(result).value();
}

DracoMesh::~DracoMesh() = default;

std::vector<std::array<std::uint32_t, 3>> DracoMesh::triangles() const {
  std::vector<std::array<std::uint32_t, 3>> out;
  for (draco::FaceIndex f(0); f < decoded_->mesh->num_faces(); ++f) {
    const draco::Mesh::Face& face = decoded_->mesh->face(f);
    out.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return out;
}

std::vector<double> DracoMesh::values(std::uint32_t id, std::size_t components) const {
  const draco::PointAttribute* attribute = decoded_->mesh->GetAttributeByUniqueId(id);
  if (!attribute || std::size_t(attribute->num_components()) != components || components > 4) return {};
  std::vector<double> out;
  for (draco::PointIndex i(0); i < decoded_->mesh->num_points(); ++i) {
    float values[4] = {};
    attribute->ConvertValue<float>(attribute->mapped_index(i), std::int8_t(components), values);
    for (std::size_t k = 0; k < components; ++k) out.push_back(double(values[k]));
  }
  return out;
}

}  // namespace rubble
