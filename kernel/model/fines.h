// Fines: debris in a settled pile that is too small or too limp to settle with it. Grit, flakes, shards,
// sheets and drifts of dust lie on the pieces; cables and pipes hang between them.
//
//   PileState + FinesSpec --strew_fines--> Fines, with heaps: one mesh a kind, host and cell
//
// Fines are true geometry: they are drawn, labelled and exported, and count in queries and voids. They have no
// contacts: no piece and no robot feels them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// In the order of their classes in the stream `label`.
enum class FineKind : std::uint8_t { grit, plaster, glass, paper, cloth, dust, cable, pipe };
inline constexpr int kFineKinds = 8;
// Their names: "grit", "plaster", ...
const std::array<std::string, kFineKinds>& fine_names();

// Amounts of fines. Shares divide `amount`; only their ratios matter.
struct FinesSpec {
  int amount = 0;                          // number of loose pieces; 0: no fines; range: 0 to 1000000
  double grit = 1, plaster = 0.05, glass = 0.02, paper = 0.002, cloth = 0.0003;  // shares; >= 0
  std::array<double, 2> size{0.003, 0.05};  // of grit, its longest side; unit: m; range: 0.002 to 0.2
  // The number of grains longer than d is proportional to d^-exponent (Turcotte 1986, "Fractals and
  // fragmentation": 1.9 for crushed quartz, 2.5 for broken coal and basalt); range: 1 to 4
  double exponent = 2.0;
  int drifts = 80;  // mounds of dust, at the foot of walls; range: 0 to 2000
  int cables = 10;  // hanging cables; range: 0 to 500
  int pipes = 4;    // hanging pipes; range: 0 to 500
};

inline constexpr int kFineShapes = 80;

// A loose piece: a shape of kernel/geometry/fine_shapes.h, scaled along its axes.
struct FinePiece {
  FineKind kind = FineKind::grit;
  std::uint8_t surface = 0;   // index into Fines::surfaces
  std::uint16_t shape = 0;    // number of its shape; range: 0 to kFineShapes - 1
  std::int32_t host = -1;     // index of the piece that it lies on; -1: the ground
  Vec3f position;             // of its middle, in the frame of the host; unit: m
  Quatf rotation;             // host from shape
  Vec3f half;                 // scale of the shape along its axes; unit: m
};

// A fine with a shape of its own: paper, cloth, a drift, a cable, a pipe.
struct FineSheet {
  FineKind kind = FineKind::dust;
  std::int32_t host = -1;    // as of a FinePiece
  std::uint8_t surface = 0;  // as of a FinePiece
  // Closed, in the frame of the host. Its surfaces and surface_names are empty.
  TriangleMesh mesh;
};

// All fines of one kind on one host within one cell of its frame: one mesh with one number.
struct FineHeap {
  FineKind kind = FineKind::grit;
  std::int32_t host = -1;  // as of a FinePiece
  TriangleMesh mesh;       // closed; in the frame of the host, without its scale
};

struct Fines {
  std::vector<std::string> surfaces;  // looks, as in TriangleMesh::surface_names
  std::vector<FinePiece> pieces;      // loose pieces
  std::vector<FineSheet> sheets;      // all else

  std::shared_ptr<const std::vector<FineHeap>> gathered{};  // by heap_fines(), which whoever makes or changes fines calls

  bool empty() const { return pieces.empty() && sheets.empty(); }
  // In order of kind, host and cell: the heap number kFirstFineHeap + i is the i-th. Throws std::logic_error where
  // nobody called heap_fines().
  const std::vector<FineHeap>& heaps() const;
};

// The number of a pile's first heap in the stream `instance`, in exports and in results of queries, where pieces
// have their index. A float holds it exactly, as EXR files need.
inline constexpr int kFirstFineHeap = 10'000'000;

}  // namespace rubble
