// The readers of meshes in the process of the fuzzer: a crash of theirs is a finding.
#pragma once

#include "io/import/mesh_join.h"
#include "io/import/mesh_paint.h"
#include "io/import/mesh_winding.h"
#include "io/mesh_formats/scene_reader.h"
#include "tests/fuzz/fuzz_file.h"

namespace rubble::fuzz {

inline void read_mesh(const std::string& name, std::string_view bytes) {
  const std::string path = folder().write(name, bytes);
  knock([&] {
    ImportedScene scene = read_scene(path);
    MeshPaints paints(scene, path);
    TriangleMesh mesh = join_meshes(scene, path, {}, paints);
    weld_cracks(mesh);
    agree_on_outside(mesh);
    calc_volume_properties(mesh);
  });
}

}  // namespace rubble::fuzz
