#include "io/mesh/pile_model.h"

#include <cstring>
#include <unordered_map>

#include "kernel/base/number_text.h"

namespace rubble {
namespace {

struct PositionHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a over words
    for (const std::uint32_t word : bits) hash = (hash ^ word) * 1099511628211u;
    return hash ^ (hash >> 29);
  }
};

std::array<std::uint32_t, 3> bits_of(const Vec3f& p) {
  const float values[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 and 0 are one place
  std::array<std::uint32_t, 3> bits;
  std::memcpy(bits.data(), values, sizeof values);
  return bits;
}

}  // namespace

Vec3f PileModel::colour_of(const std::string& surface) const {
  for (const PlainAppearance& look : surface_appearance)
    if (look.surface == surface) return look.colour;
  return {0.3f, 0.3f, 0.3f};
}

std::string piece_name(const std::string& asset, std::size_t number) {
  return asset + "_" + index_text(static_cast<int>(number));
}

// The map is only asked, never walked: numbers follow first use.
WeldedMesh weld(const TriangleMesh& mesh) {
  WeldedMesh welded;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PositionHash> numbers;
  std::vector<std::uint32_t> number_of;
  for (const Vec3f& p : mesh.positions) {
    const auto next = static_cast<std::uint32_t>(welded.positions.size());
    const auto [found, is_new] = numbers.try_emplace(bits_of(p), next);
    if (is_new) welded.positions.push_back(p);
    number_of.push_back(found->second);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const std::array<std::uint32_t, 3> w{number_of[t[0]], number_of[t[1]], number_of[t[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) continue;
    welded.triangles.push_back(w);
    welded.sources.push_back(std::uint32_t(i));
    welded.surfaces.push_back(mesh.surfaces.empty() ? std::uint8_t{0} : mesh.surfaces[i]);
    if (!mesh.normals.empty()) welded.normals.push_back(t);
  }
  return welded;
}

Vec3f world_position(const PileModel::Piece& piece, const Vec3f& position) {
  return Vec3f(piece.world_from_body * (Vec3(position) * piece.scale));
}

}  // namespace rubble
