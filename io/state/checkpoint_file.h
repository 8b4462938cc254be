// A checkpoint of settling as a file. Settling continues from it, bit for bit.
//
// In the envelope of io/base/sealed_file.h, kind "RUBCHKP\n":
//   u64 fingerprint of the pile and the options; i32 layers spawned, i32 layers that reached their
//   limit, i64 steps since the last spawn; u64 size of the world's state and its bytes, in the
//   format and version of kernel/world/world_snapshot.h
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
