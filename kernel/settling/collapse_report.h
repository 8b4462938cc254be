// What a collapse has come to, as plain data.
#pragma once

namespace rubble {

// How far a collapse has come.
struct CollapseReport {
  int bonds = 0, broken = 0, hinges = 0;
  int ties = 0, torn = 0;       // bars that held on when the concrete failed, and those of them that tore
  double tie_energy = 0;        // what they took as they yielded; unit: J
  double energy_taken = 0;      // by what broke under impacts; unit: J
  double stress_seconds = 0;    // wall time of the stress solutions; for benches, never part of a result
  int solutions = 0;
};

}  // namespace rubble
