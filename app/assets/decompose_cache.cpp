#include "app/assets/decompose_cache.h"

namespace rubble {
namespace {

constexpr int kVersion = 2;  // raise it whenever decompose() changes

std::string key_of(const TriangleMesh& mesh, const DecomposeOptions& o) {
  CacheKey key("decompose", kVersion);
  key.add(o.max_parts).add(o.tolerance).add(o.resolution).add(o.max_corners).add(o.thinnest);
  key.add(std::uint64_t(mesh.positions.size())).add(std::uint64_t(mesh.triangles.size()));
  for (const Vec3f& p : mesh.positions) key.add(p.x).add(p.y).add(p.z);
  for (const auto& t : mesh.triangles) key.add(t[0]).add(t[1]).add(t[2]);
  return key.hex();
}

struct Triple {
  double x, y, z;
};

std::vector<ConvexPart> unpack(const std::string& bytes) {
  CacheReader reader(bytes);
  std::uint64_t count = 0;
  reader.get(count);
  std::vector<ConvexPart> parts;
  for (std::uint64_t i = 0; i < count && i < 1000; ++i) {
    std::vector<Triple> points;
    reader.get(points);
    parts.emplace_back();
    for (const Triple& p : points) parts.back().points.push_back({p.x, p.y, p.z});
  }
  if (!reader.whole()) parts.clear();
  return parts;
}

std::string pack(const std::vector<ConvexPart>& parts) {
  CacheWriter writer;
  writer.put(std::uint64_t(parts.size()));
  for (const ConvexPart& part : parts) {
    std::vector<Triple> points;
    for (const Vec3& p : part.points) points.push_back({p.x, p.y, p.z});
    writer.put(points);
  }
  return writer.bytes();
}

}  // namespace

std::vector<ConvexPart> decompose_cached(const TriangleMesh& mesh, const DiskCache& cache,
                                         const DecomposeOptions& options) {
  const std::string key = key_of(mesh, options);
  if (const std::optional<std::string> kept = cache.find("parts", key)) {
    std::vector<ConvexPart> parts = unpack(*kept);
    if (!parts.empty()) return parts;
  }
  std::vector<ConvexPart> parts = decompose(mesh, options);
  cache.store("parts", key, pack(parts));
  return parts;
}

}  // namespace rubble
