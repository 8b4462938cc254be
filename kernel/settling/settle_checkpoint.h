// State of settling, as plain data. Continuing from it gives the result of a run without a stop, bit for bit.
// io/state/checkpoint_file saves and loads it.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

struct Pile;
struct SettleOptions;

struct SettleCheckpoint {
  std::uint64_t work = 0;            // hash_work() of the pile and the options
  std::int32_t layers = 0;           // spawned so far; 0: placed pieces are still settling
  std::int32_t layers_at_limit = 0;  // number of layers that reached their time limit before rest
  std::int64_t layer_steps = 0;      // steps since the last spawn
  std::vector<std::uint8_t> world;   // encode_snapshot() of the world
};

// Fingerprint of the inputs of the result: the pile, and the options except the threads.
std::uint64_t hash_work(const Pile& pile, const SettleOptions& options);

}  // namespace rubble
