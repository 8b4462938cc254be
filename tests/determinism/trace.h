// Traces: the bits of every body after every step, in a file, and the first place where two differ.
//
// The file holds, after a line that names the format, one record a step: the scene, the step, the
// number of bodies, and the bodies whose bits changed since the record before, each as its number
// and 13 doubles. Little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "kernel/world/world.h"

namespace rubble::determinism {

// Rotation w x y z, position x y z, linear velocity x y z, angular velocity x y z; as bit patterns.
using BodyBits = std::array<std::uint64_t, 13>;
BodyBits bits_of(const PieceState& piece);

class TraceWriter {
 public:
  explicit TraceWriter(const std::string& path);  // throws RunError
  void begin_scene(const std::string& name);
  void add(const World& world);
  void finish();  // throws RunError when something could not be written

 private:
  std::string path_, scene_;
  std::ofstream file_;
  std::vector<BodyBits> last_;
};

// The first scene, step, body and field that differ, with both values and how many bodies differ
// in that step; empty when the traces are the same. Throws RunError for a file that is no trace.
std::string compare_traces(const std::string& path_a, const std::string& path_b);

}  // namespace rubble::determinism
