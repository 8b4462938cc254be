// Loose pieces - grit, flakes of plaster, shards of glass - let fall in heaps: most of them near each other, where
// something broke, and a few far off.
#pragma once

#include <vector>

#include "kernel/fines/fine_sites.h"
#include "kernel/fines/fine_surfaces.h"

namespace rubble {

// What the grains of a pile are strewn on, and what they add to.
struct GrainGround {
  const PileState& pile;
  const PileQueries& queries;
  const std::vector<FineSite>& sites;
  const FragmentTable& fragments;
  const StrewOptions& options;
  std::vector<int> heap_hosts{};  // of the heaps of fines that `queries` knows

  // The piece that carries what an answer of `queries` names.
  int host_of(int piece) const {
    return piece < kFirstFineHeap ? piece : heap_hosts[std::size_t(piece - kFirstFineHeap)];
  }
};

// Strews `amount` pieces of a kind, or as many as there is room for, and reports it with all in `pieces` to
// options.progress. kind: grit, plaster or glass.
void strew_grains(const GrainGround& ground, FineKind kind, int amount, const FinesSpec& spec, RoomForFines& room,
                  std::vector<FinePiece>& pieces);

// How many of `amount` pieces are of each of the kinds with a share.
std::array<int, 5> share_amount(const FinesSpec& spec);

// How readily fines gather at a site. 0: never.
double calc_site_weight(const FineSite& site, const FinePatches& patches);

// Sheets of paper, whole and torn, with corners that curl; and cloth that drapes over what it fell on.
// kind: paper or cloth. As many as asked for, or as many as there is room for.
void drop_sheets(const GrainGround& ground, FineKind kind, int count, RoomForFines& room,
                 std::vector<FineSheet>& sheets);

// Low mounds of dust and the finest debris: at the foot of walls and in corners, and a few on open floors.
// As many as asked for, or as many as there is room for.
void heap_drifts(const GrainGround& ground, int count, std::vector<FineSheet>& sheets);

}  // namespace rubble
