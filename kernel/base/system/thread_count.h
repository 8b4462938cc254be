// Number of threads of programs. No result depends on it.
#pragma once

namespace rubble {

// How many threads work when nobody says a number: that of the environment variable RUBBLE_THREADS if that is set, else
// as many as there are processors that this process may use (taskset, cgroups with a quota of processor time,
// containers). At least 1. Throws InputError where the variable is no whole number from 1 to 1024.
int default_thread_count();

}  // namespace rubble
