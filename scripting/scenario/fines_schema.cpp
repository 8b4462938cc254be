// The keys of fines: what is strewn over a pile that has settled.
#include "scripting/scenario/pile_schema.h"

namespace rubble {

void add_fine_keys(Schema& k, FinesSpec& f) {
  k.group("fines",
          "Fines on the settled pile, as true geometry: grit, flakes, shards, paper, cloth, drifts of dust, hanging "
          "cables and pipes (docs/fines.md).");
  k.value("fines.amount", f.amount, "Number of loose pieces; 0: no fines of any kind.").between(0, 1000000);
  k.value("fines.grit", f.grit, "Share of grit: broken concrete, brick, block or wood, like the pieces near it.")
      .between(0, 1000);
  k.value("fines.plaster", f.plaster, "Share of flakes of plaster, 8 to 110 mm long.").between(0, 1000);
  k.value("fines.glass", f.glass, "Share of shards of glass, 4 to 80 mm long.").between(0, 1000);
  k.value("fines.paper", f.paper, "Share of sheets of paper, A4 and smaller, whole or torn.").between(0, 1000);
  k.value("fines.cloth", f.cloth, "Share of pieces of cloth, 0.24 to 0.76 m long.").between(0, 1000);
  k.value("fines.size", f.size, "Longest side of grit: from the first to the second.").between(0.002, 0.2).unit("m");
  k.value("fines.exponent", f.exponent,
          "The number of pieces of grit longer than d is proportional to d to the power of minus this.")
      .between(1, 4);
  k.value("fines.drifts", f.drifts, "Number of drifts of dust, most of them at the foot of walls.").between(0, 2000);
  k.value("fines.cables", f.cables, "Number of hanging cables.").between(0, 500);
  k.value("fines.pipes", f.pipes, "Number of hanging pipes.").between(0, 500);
}

void check_fines(const FinesSpec& f, std::vector<Diagnostic>& mistakes) {
  if (f.amount > 0 && f.grit + f.plaster + f.glass + f.paper + f.cloth <= 0)
    mistakes.push_back({"", 0, "fines.grit", "no kind of loose piece has a share",
                        "a share above 0 of grit, plaster, glass, paper or cloth", "0 of each",
                        "with fines.amount = 0 there are no fines"});
}

}  // namespace rubble
