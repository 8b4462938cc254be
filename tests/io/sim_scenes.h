// A scene for simulators: a free wedge, a door on a fixed frame, a chain by balls, a bundled robot, terrain and cameras.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "io/mesh/mesh_file.h"
#include "io/scenes/sim_scene.h"
#include "tests/io/all_recorders.h"
#include "tests/io/small_scene.h"
#include "tests/io/support.h"

namespace rubble {
namespace sim_scene_test {

class SimScenes : public ::testing::Test {
 protected:
  SimScenes();

  std::string write(const std::string& format) {
    export_pile(model_, format, folder_.path());
    return folder_ / format;
  }
  double free_mass() const {
    double mass = 0;
    for (const SimModel& m : model_.sim.models)
      for (std::size_t i = 0; i < m.links.size(); ++i)
        if (!m.fixed || i > 0) mass += m.links[i].mass;
    return mass;
  }

  TriangleMesh slab_, spike_;
  ExportModel model_;
  test::ScratchFolder folder_;
};

}  // namespace sim_scene_test
}  // namespace rubble
