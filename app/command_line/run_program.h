// The program from its arguments to its exit code.
#pragma once

namespace rubble {

// Hands the line to its command, and turns errors into messages on standard error and an exit code. Sets the action
// of SIGXFSZ. main() calls nothing else; tests call it in a forked process, which spares the loading of libraries.
int run_program(int argc, char** argv);

}  // namespace rubble
