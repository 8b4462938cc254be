// Numbers and meshes as the page of a dataset holds them: base64 of little-endian arrays.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/report/html_text.h"
#include "kernel/base/math.h"

namespace rubble {

template <typename T>
std::string pack(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

inline void add(std::vector<float>& values, const Vec3& p) {
  for (int i = 0; i < 3; ++i) values.push_back(float(p[i]));
}

// Distinct positions of the triangles alone, and their corners.
struct PackedMesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  nlohmann::ordered_json json() const { return {{"positions", pack(positions)}, {"indices", pack(indices)}}; }
};

// The robots of a run for the page that shows it: their links, and where these were.
// Of robots/robots.json, robots/track.bin and what is beside them; an empty list where the run has no robots. Each robot
// has a name, the way of its first link, and links with a mesh and a pose for each of the stamps (seconds).
// Throws InputError for files that are not sound.
nlohmann::ordered_json describe_robots_of(const std::string& folder);

}  // namespace rubble
