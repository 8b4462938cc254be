// What threads gain in the sweeps of a step, by their plan.
#pragma once

#include <cstdint>

namespace rubble {

// Of one sweep. Times are in rows of batches of sixteen contacts.
struct SweepFigures {
  int threads = 1, contacts = 0, batches = 0;
  int chain = 0;             // contacts that must wait for each other, at most
  int waits = 0;             // times that a thread looks whether others have come so far, at most
  std::int64_t work = 0;     // of all threads
  std::int64_t longest = 0;  // of the chain that takes longest: no number of threads is faster
  std::int64_t time = 0;     // until the last thread is done, with all waiting
};

}  // namespace rubble
