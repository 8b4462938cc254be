// A pause in settling as a file, from which settling continues bit for bit as if it had not paused.
//
// In the envelope of io/base/sealed_file.h, kind "RUBCHKP\n":
//   u64 fingerprint of the pile and the options; i32 layers spawned, i32 layers that ran into their
//   limit, i64 steps since the last spawn; u64 size of the world's state and its bytes, whose
//   format and version are those of kernel/world/world_snapshot.h
#pragma once

#include <cstdint>
#include <string>

#include "kernel/settling/settle_checkpoint.h"

namespace rubble {

inline constexpr std::uint32_t kCheckpointVersion = 1;

// Throws RunError when the file cannot be written.
void save_checkpoint(const SettleCheckpoint& checkpoint, const std::string& path);

// Throws InputError for a missing, foreign, truncated or altered file, or another version.
SettleCheckpoint load_checkpoint(const std::string& path);

}  // namespace rubble
