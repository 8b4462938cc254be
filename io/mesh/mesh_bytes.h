// Meshes as plain bytes, from one process to another of the same program on the same machine.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "kernel/base/error.h"
#include "kernel/base/mesh.h"

namespace rubble {

inline void put_text(CacheWriter& writer, const std::string& text) {
  writer.put(std::vector<char>(text.begin(), text.end()));
}

inline std::string get_text(CacheReader& reader) {
  std::vector<char> text;
  reader.get(text);
  return {text.begin(), text.end()};
}

// note: goes with it.
inline std::string mesh_to_bytes(const TriangleMesh& mesh, const std::string& note) {
  CacheWriter writer;
  writer.put(mesh.positions);
  writer.put(mesh.normals);
  writer.put(mesh.triangles);
  writer.put(mesh.surfaces);
  writer.put(std::uint64_t(mesh.surface_names.size()));
  for (const std::string& name : mesh.surface_names) put_text(writer, name);
  put_text(writer, note);
  return writer.bytes();
}

inline TriangleMesh mesh_from_bytes(const std::string& bytes, std::string& note) {
  CacheReader reader(bytes);
  TriangleMesh mesh;
  reader.get(mesh.positions);
  reader.get(mesh.normals);
  reader.get(mesh.triangles);
  reader.get(mesh.surfaces);
  std::uint64_t names = 0;
  reader.get(names);
  for (std::uint64_t i = 0; i < names && i < 256; ++i)
    mesh.surface_names.push_back(get_text(reader));
  note = get_text(reader);
  if (!reader.whole()) throw RunError("a mesh was cut short between two processes");
  return mesh;
}

inline std::string parts_to_bytes(const std::vector<std::vector<Vec3>>& parts) {
  CacheWriter writer;
  writer.put(std::uint64_t(parts.size()));
  for (const std::vector<Vec3>& points : parts) writer.put(points);
  return writer.bytes();
}

inline std::vector<std::vector<Vec3>> parts_from_bytes(const std::string& bytes) {
  CacheReader reader(bytes);
  std::uint64_t count = 0;
  reader.get(count);
  std::vector<std::vector<Vec3>> parts;
  for (std::uint64_t i = 0; i < count && i < bytes.size(); ++i) {
    parts.emplace_back();
    reader.get(parts.back());
  }
  if (!reader.whole()) throw RunError("convex parts were cut short between two processes");
  return parts;
}

}  // namespace rubble
