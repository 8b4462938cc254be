// The scenes whose state hashes are promised to be the same everywhere; see docs/explanation/determinism.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernel/world/world.h"

namespace rubble::determinism {

struct SceneOptions {
  int threads = 1;  // 0: all processors
  double push = 0;  // moves one piece along X before the first step; unit: m
  std::function<void(const World&)> after_step;  // may be empty
};

struct SceneResult {
  std::int64_t step = 0;   // at which rest was reached, or the number asked for
  std::uint64_t hash = 0;  // PileState::state_hash()
};

struct Scene {
  std::string name;
  SceneResult (*run)(const SceneOptions&);
};

const std::vector<Scene>& standard_scenes();
// Throws InputError, listing the names there are.
const Scene& find_scene(const std::string& name);

// "name step hash", as in tests/golden/kernel.txt.
std::string format_result(const std::string& scene, const SceneResult& result);

}  // namespace rubble::determinism
