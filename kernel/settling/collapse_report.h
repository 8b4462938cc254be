// Figures of a collapse, as plain data.
#pragma once

namespace rubble {

// Progress of a collapse.
struct CollapseReport {
  int bonds = 0, broken = 0, hinges = 0;
  int ties = 0, torn = 0;       // bars that held after the concrete failed; those of them that tore
  double tie_energy = 0;        // absorbed by yielding ties; unit: J
  double energy_taken = 0;      // absorbed by fracture under impacts; unit: J
  double stress_seconds = 0;    // wall time of the stress solutions; for benches, never part of a result
  int solutions = 0;
};

}  // namespace rubble
