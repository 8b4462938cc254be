// A world's snapshot as bytes, and back: what is decoded continues bit for bit as the original. World::restore() removes the
// robots and surfaces that the world has got since.
//
// Little-endian, no padding: u32 format version, then each member in the order of world_serialization.h;
// a list is a u64 count and its elements. There is no checksum: io/checkpoint_file adds one.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/world/world.h"

namespace rubble {

// Changes whenever a member of the world's data is added, removed or moved.
inline constexpr std::uint32_t kWorldSnapshotVersion = 11;

std::vector<std::uint8_t> encode_snapshot(const World::Snapshot& snapshot);

// Throws InputError for bytes of another version, cut short, too long, or that refer to pieces or
// contacts which they do not hold.
std::shared_ptr<const World::Snapshot> decode_snapshot(const std::vector<std::uint8_t>& bytes);

}  // namespace rubble
