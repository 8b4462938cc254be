#include "app/assets/decompose_cache.h"

namespace rubble {
namespace {

constexpr int kVersion = 3;  // raise it whenever decompose() changes

std::string key_of(const TriangleMesh& mesh, const DecomposeOptions& o) {
  CacheKey key("decompose", kVersion);
  key.add(o.max_parts).add(o.most_parts).add(o.tolerance).add(o.most_outside).add(o.most_gap).add(o.resolution).add(o.max_corners).add(o.thinnest);
  key.add(std::uint64_t(mesh.positions.size())).add(std::uint64_t(mesh.triangles.size()));
  for (const Vec3f& p : mesh.positions) key.add(p.x).add(p.y).add(p.z);
  for (const auto& t : mesh.triangles) key.add(t[0]).add(t[1]).add(t[2]);
  return key.hex();
}

struct Triple {
  double x, y, z;
};

// Without parts: damaged.
Decomposition unpack(const std::string& bytes) {
  CacheReader reader(bytes);
  Decomposition kept;
  std::uint64_t count = 0;
  std::uint8_t exact = 0;
  reader.get(exact), reader.get(kept.volume);
  reader.get(kept.misfit.outside), reader.get(kept.misfit.inside), reader.get(kept.misfit.gap);
  kept.exact = exact != 0;
  reader.get(count);
  std::vector<ConvexPart>& parts = kept.parts;
  for (std::uint64_t i = 0; i < count && i < 1000; ++i) {
    std::vector<Triple> points;
    reader.get(points);
    parts.emplace_back();
    for (const Triple& p : points) parts.back().points.push_back({p.x, p.y, p.z});
  }
  if (!reader.whole()) parts.clear();
  return kept;
}

std::string pack(const Decomposition& made) {
  CacheWriter writer;
  writer.put(std::uint8_t(made.exact)), writer.put(made.volume);
  writer.put(made.misfit.outside), writer.put(made.misfit.inside), writer.put(made.misfit.gap);
  writer.put(std::uint64_t(made.parts.size()));
  for (const ConvexPart& part : made.parts) {
    std::vector<Triple> points;
    for (const Vec3& p : part.points) points.push_back({p.x, p.y, p.z});
    writer.put(points);
  }
  return writer.bytes();
}

}  // namespace

Decomposition decompose_cached(const TriangleMesh& mesh, const DiskCache& cache,
                               const DecomposeOptions& options) {
  const std::string key = key_of(mesh, options);
  if (const std::optional<std::string> kept = cache.find("parts", key)) {
    Decomposition made = unpack(*kept);
    if (!made.parts.empty()) return made;
  }
  Decomposition made = decompose(mesh, options);
  cache.store("parts", key, pack(made));
  return made;
}

}  // namespace rubble
