// The fines of a pile as a file: fines.bin. What is loaded equals what was saved bit for bit.
//
// In the envelope of io/base/sealed_file.h, kind "RUBFINE\n":
//   u32 count of surfaces, each u32 length + UTF-8 name;
//   u64 count of loose pieces, each: u8 kind, u8 surface, u16 shape, i32 host (-1: the ground), f32 position x y z,
//       f32 rotation w x y z, f32 half sides x y z;
//   u64 count of sheets, each: u8 kind, u8 surface, i32 host, u32 count of vertices, each f32 position x y z and
//       normal x y z, u32 count of triangles, each u32 corners
// Kinds are numbered as in kernel/model/fines.h, shapes as in kernel/geometry/fine_shapes.h. Positions are in the
// frame of the host, at scale 1.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/model/fines.h"

namespace rubble {

inline constexpr std::uint32_t kFinesVersion = 1;

// Throws RunError when the file cannot be written.
void save_fines(const Fines& fines, const std::string& path);

// pieces: of the pile that the fines lie on. Throws InputError for a missing, foreign, truncated or altered file,
// another version, numbers that are not finite, and what refers to a piece, shape or surface that is not there.
// They have no heaps: heap_fines() makes them.
Fines load_fines(const std::string& path, std::size_t pieces);

}  // namespace rubble
