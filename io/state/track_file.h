// A track as a file: track.bin. Loading gives the saved bits.
//
// In the envelope of io/base/sealed_file.h, kind "RUBTRCK\n":
//   u64 count of samples, each f64 its time in s;
//   u64 count of bodies, each: i32 id, f64 centre of mass x y z in the body's frame, u32 the first
//       sample without the body (0xffffffff: it stays), u64 count of keys, each: u32 sample,
//       f64 rotation w x y z, f64 translation x y z, f32 linear velocity of the centre of mass x y z,
//       f32 angular velocity x y z
#pragma once

#include <cstdint>
#include <string>

#include "kernel/model/track.h"

namespace rubble {

inline constexpr std::uint32_t kTrackVersion = 1;

// Throws RunError when the file cannot be written.
void save_track(const Track& track, const std::string& path);

// Throws InputError for a missing, foreign, truncated or altered file, another version, or an invalid track
// (Track::find_fault).
Track load_track(const std::string& path);

}  // namespace rubble
