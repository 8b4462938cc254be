// What the programs of the bench share around their work.
#pragma once

#include <functional>

#include "kernel/base/error.h"

namespace CLI {
class App;
}

namespace rubble {

// Calls `work` when the command line is right; else prints the help, or what is wrong.
ExitCode parse_and_run(CLI::App& app, int argc, char** argv, const std::function<ExitCode()>& work);

// Calls `run` and turns errors into a message on stderr and an exit code.
int run_program(const char* name, const std::function<ExitCode()>& run);

}  // namespace rubble
