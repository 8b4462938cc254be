// The scene and the camera paths of render_bench.
#pragma once

#include <string>
#include <vector>

#include "render/scene/frame.h"
#include "render/scene/scene.h"

namespace rubble {

// bench/render_views.lua, settled. The settled pile is kept in the disk cache. `report` gets lines
// about what takes long. fines: FinesSpec::amount, in place of the mission's.
// surrounded: with a street about the pile.
Scene load_bench_scene(const std::string& mission, int threads, void (*report)(const char*), int fines = 0,
                       bool surrounded = false);

struct BenchView {
  const char* name;
  // Poses of a slow flight at 30 Hz.
  std::vector<Pose> (*path)(int frames);
};
const std::vector<BenchView>& bench_views();

// 80 degrees wide.
Intrinsics bench_camera(int size);

}  // namespace rubble
