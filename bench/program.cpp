#include "bench/program.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace rubble {

ExitCode parse_and_run(CLI::App& app, int argc, char** argv, const std::function<ExitCode()>& work) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  return work();
}

int run_program(const char* name, const std::function<ExitCode()>& run) {
  try {
    return int(run());
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(ExitCode::bad_input);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return int(ExitCode::failure);
  }
}

}  // namespace rubble
