// Where settling is, as plain data: continuing from it equals never having stopped, bit for bit.
// io/checkpoint_file saves and loads it.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

struct Pile;
struct SettleOptions;

struct SettleCheckpoint {
  std::uint64_t work = 0;            // hash_work() of the pile and the options
  std::int32_t layers = 0;           // spawned so far; 0: what was placed is still settling
  std::int32_t layers_at_limit = 0;  // whose time limit came before rest
  std::int64_t layer_steps = 0;      // steps since the last spawn
  std::vector<std::uint8_t> world;   // encode_snapshot() of the world
};

// Fingerprint of what the result depends on: the pile, and the options except the threads.
std::uint64_t hash_work(const Pile& pile, const SettleOptions& options);

}  // namespace rubble
