// Clocks and memory of this process, for the programs of the bench.
#pragma once

namespace rubble {

struct Times {
  double wall = 0, cpu = 0;  // of all threads; unit: s

  Times operator-(const Times& t) const { return {wall - t.wall, cpu - t.cpu}; }
  Times& operator+=(const Times& t) { return wall += t.wall, cpu += t.cpu, *this; }
};

Times read_times();      // since some fixed moment
double read_peak_rss();  // most that was ever resident; unit: MiB

}  // namespace rubble
