// Settles a pile, settles it again to compare, and exports it: with the kernel alone.
//   settle_pile settle SEED FOLDER   leaves FOLDER/pile.bin
//   settle_pile verify SEED FOLDER   the same bits here? exit code 5 if not
//   settle_pile export FOLDER        leaves FOLDER/pile.stl
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bricks_and_slabs.h"
#include <rubble/io/mesh/stl_writer.h>
#include <rubble/io/state/pile_state_file.h>
#include <rubble/kernel/base/hash.h>
#include <rubble/kernel/settling/generator.h>
#include <rubble/kernel/settling/settle.h>

namespace {

rubble::PileState settle(std::uint64_t seed) {
  const rubble::PileState pile = rubble::settle_pile(rubble::generate_pile(make_spec(seed)));
  std::printf("state hash %s, %s\n", rubble::hex64(pile.state_hash()).c_str(),
              pile.settled ? "settled" : "did not settle");
  return pile;
}

int verify(std::uint64_t seed, const std::string& folder) {
  const bool same = settle(seed).state_hash() == rubble::load_pile_state(folder + "/pile.bin").state_hash();
  std::printf("%s\n", same ? "the same" : "not the same");
  return same ? 0 : 5;
}

// Six faces of two triangles each, counter-clockwise seen from outside.
rubble::TriangleMesh mesh_of(const rubble::PieceType& box) {
  rubble::TriangleMesh mesh;
  for (const rubble::Vec3& corner : box.parts[0].points) mesh.positions.push_back(rubble::Vec3f(corner));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

void write_mesh(const std::string& folder) {
  std::vector<rubble::TriangleMesh> meshes;
  for (const rubble::PieceType& type : make_spec(0).types) meshes.push_back(mesh_of(type));
  std::vector<rubble::MeshInstance> instances;
  for (const rubble::PieceState& piece : rubble::load_pile_state(folder + "/pile.bin").pieces)
    if (piece.status != rubble::PieceStatus::lost)
      instances.push_back({&meshes[std::size_t(piece.type)], piece.scale, piece.world_from_body});
  rubble::write_stl(folder + "/pile.stl", instances);
}

int run(const std::vector<std::string>& words) {
  const std::string verb = words.empty() ? "" : words[0];
  if (verb == "export" && words.size() == 2) return write_mesh(words[1]), 0;
  if ((verb != "settle" && verb != "verify") || words.size() != 3) {
    std::fprintf(stderr, "usage: settle_pile settle|verify SEED FOLDER, settle_pile export FOLDER\n");
    return 1;
  }
  const std::uint64_t seed = std::strtoull(words[1].c_str(), nullptr, 10);
  if (verb == "verify") return verify(seed, words[2]);
  rubble::save_pile_state(settle(seed), words[2] + "/pile.bin");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "settle_pile: %s\n", e.what()), 2;
  }
}
