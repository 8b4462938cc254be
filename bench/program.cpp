#include "bench/program.h"

#include <cstdio>
#include <exception>

namespace rubble {

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
