// Asks about a pile that settle_pile left: a ray from above, and the voids.
//   find_voids FOLDER/pile.bin
#include <cstdio>
#include <exception>
#include <vector>

#include "bricks_and_slabs.h"
#include <rubble/io/state/pile_state_file.h>
#include <rubble/kernel/queries/queries.h>
#include <rubble/kernel/voids/void_map.h>

namespace {

void run(const char* path) {
  const rubble::PileState pile = rubble::load_pile_state(path);
  const std::vector<rubble::TriangleMesh> shapes = rubble::make_collision_meshes(make_spec(0).types);
  std::vector<const rubble::TriangleMesh*> meshes;
  for (const rubble::TriangleMesh& mesh : shapes) meshes.push_back(&mesh);
  const rubble::PileQueries queries(pile, meshes);
  if (const auto hit = queries.cast_ray({0, 0, 10}, {0, 0, -1}, 20))
    std::printf("the pile is %.6f m high over the origin\n", hit->point.z);
  rubble::VoidSpaceOptions options;
  options.voxel = 0.04;
  const rubble::VoidMap voids = rubble::find_voids(rubble::calc_void_space(pile, meshes, options), {0.1});
  std::printf("voids for a robot of 0.1 m radius: %.6f m3\n", voids.robots[0].volume);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: find_voids PILE.bin\n"), 1;
  try {
    run(argv[1]);
    return 0;
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "find_voids: %s\n", e.what()), 2;
  }
}
