// Ctrl-C and a polite kill: the run ends between two steps, so that it can be continued.
#pragma once

#include <string>

namespace rubble {

// From now on SIGINT, SIGTERM and SIGHUP (unless ignored: `nohup`) only set a mark; one that comes two seconds later ends the
// program.
void stop_on_signals();
bool stop_requested();

// Throws Stopped once one of them came. folder: of the unfinished run, for the message; empty: none.
void throw_if_stopped(const std::string& folder);

}  // namespace rubble
