#include "kernel/fines/strew_fines.h"

#include <algorithm>

#include "kernel/fines/grains.h"
#include "kernel/fines/strands.h"
#include "kernel/geometry/fine_shapes.h"

namespace rubble {
namespace {

// Enough of them that a heap seldom falls on the site of another.
constexpr int kLeastLines = 1500, kMostLines = 12000, kPiecesPerLine = 8;

void drop_all_sheets(const GrainGround& ground, const std::array<int, 5>& counts, RoomForFines& room, Fines& fines) {
  drop_sheets(ground, FineKind::cloth, counts[std::size_t(FineKind::cloth)], room, fines.sheets);
  drop_sheets(ground, FineKind::paper, counts[std::size_t(FineKind::paper)], room, fines.sheets);
}

}  // namespace

// Drifts come first, and the rest falls on them as on everything else.
Fines strew_fines(const PileState& pile, const std::vector<const TriangleMesh*>& meshes, const FinesSpec& spec,
                  const StrewOptions& options) {
  if (spec.amount == 0) return {};
  PileState bare = pile;
  bare.fines = {};
  bare.fines.surfaces = fine_surfaces();
  const PileQueries pieces(bare, meshes);
  const int lines = std::clamp(spec.amount / kPiecesPerLine, kLeastLines, kMostLines);
  const std::vector<FineSite> sites = find_fine_sites(bare, meshes, pieces, lines, options);
  const FragmentTable fragments(bare, meshes);
  heap_drifts({bare, pieces, sites, fragments, options, {}}, spec.drifts, bare.fines.sheets);
  Fines fines = bare.fines;
  heap_fines(bare.fines);
  const PileQueries queries(bare, meshes);
  GrainGround ground{bare, queries, sites, fragments, options};
  for (const FineHeap& heap : bare.fines.heaps()) ground.heap_hosts.push_back(heap.host);
  const std::array<int, 5> counts = share_amount(spec);
  RoomForFines room;
  hang_strands(ground, FineKind::pipe, spec.pipes, fines.sheets);
  hang_strands(ground, FineKind::cable, spec.cables, fines.sheets);
  drop_all_sheets(ground, counts, room, fines);
  for (const FineKind kind : {FineKind::plaster, FineKind::glass, FineKind::grit})
    strew_grains(ground, kind, counts[std::size_t(kind)], spec, room, fines.pieces);
  heap_fines(fines);
  return fines;
}

}  // namespace rubble
