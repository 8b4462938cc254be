// Meshes as plain bytes, from one process to another of the same program on the same machine.
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "kernel/base/mesh.h"
#include "kernel/base/system/disk_cache.h"

namespace rubble {

inline void put_text(CacheWriter& writer, const std::string& text) {
  writer.put(std::vector<char>(text.begin(), text.end()));
}

inline std::string get_text(CacheReader& reader) {
  std::vector<char> text;
  reader.get(text);
  return {text.begin(), text.end()};
}

inline void put_paint(CacheWriter& writer, const SurfacePaint& paint) {
  writer.put(paint.colour);
  for (const float x : {paint.roughness, paint.metalness, paint.reflectance}) writer.put(x);
  for (const PaintImage* image : {&paint.albedo, &paint.relief}) writer.put(image->side), writer.put(image->texels);
  put_text(writer, paint.sha256);
}

inline std::shared_ptr<const SurfacePaint> get_paint(CacheReader& reader) {
  SurfacePaint paint;
  reader.get(paint.colour);
  for (float* x : {&paint.roughness, &paint.metalness, &paint.reflectance}) reader.get(*x);
  for (PaintImage* image : {&paint.albedo, &paint.relief}) reader.get(image->side), reader.get(image->texels);
  paint.sha256 = get_text(reader);
  return std::make_shared<const SurfacePaint>(std::move(paint));
}

inline void put_texts(CacheWriter& writer, const std::vector<std::string>& texts) {
  writer.put(std::uint64_t(texts.size()));
  for (const std::string& text : texts) put_text(writer, text);
}

inline std::vector<std::string> get_texts(CacheReader& reader, std::size_t most) {
  std::uint64_t count = 0;
  reader.get(count);
  std::vector<std::string> texts;
  for (std::uint64_t i = 0; i < count && i < most; ++i) texts.push_back(get_text(reader));
  return texts;
}

// notes: go with it.
inline std::string mesh_to_bytes(const TriangleMesh& mesh, const MeshNotes& notes) {
  CacheWriter writer;
  writer.put(mesh.positions);
  writer.put(mesh.normals);
  writer.put(mesh.triangles);
  writer.put(mesh.surfaces);
  put_texts(writer, mesh.surface_names);
  writer.put(std::uint64_t(mesh.paints.size()));
  for (const auto& paint : mesh.paints) put_paint(writer, *paint);
  writer.put(mesh.paint_corners);
  put_texts(writer, notes.shape);
  put_texts(writer, notes.looks);
  return writer.bytes();
}

inline TriangleMesh mesh_from_bytes(const std::string& bytes, MeshNotes& notes) {
  CacheReader reader(bytes);
  TriangleMesh mesh;
  reader.get(mesh.positions);
  reader.get(mesh.normals);
  reader.get(mesh.triangles);
  reader.get(mesh.surfaces);
  mesh.surface_names = get_texts(reader, 256);
  std::uint64_t paints = 0;
  reader.get(paints);
  for (std::uint64_t i = 0; i < paints && i < 256; ++i) mesh.paints.push_back(get_paint(reader));
  reader.get(mesh.paint_corners);
  notes.shape = get_texts(reader, bytes.size());
  notes.looks = get_texts(reader, bytes.size());
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
