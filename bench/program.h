// What the programs of the bench share around their work.
#pragma once

#include <functional>

#include "kernel/base/error.h"

namespace rubble {

// Calls `run` and turns errors into a message on stderr and an exit code.
int run_program(const char* name, const std::function<ExitCode()>& run);

}  // namespace rubble
