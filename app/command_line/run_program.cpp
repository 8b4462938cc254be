#include "app/command_line/run_program.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "app/command_line/command.h"
#include "app/support/freed_memory.h"
#include "app/support/print.h"
#include "app/support/stop.h"

namespace rubble {
namespace {

// A descriptor that is closed would become the number of the first file that is opened, and what is
// printed would go into that. One that only reads in its place makes printing fail, as it should.
void reserve_standard_files() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) open("/dev/null", O_RDONLY);
}

// What was printed is a result: a full disk must not look like success.
ExitCode check_standard_output(ExitCode code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const std::string reason = errno ? ": " + std::generic_category().message(errno) : "";
  print_err("\nrubble: cannot write to standard output%s\n", reason.c_str());
  return code == ExitCode::done ? ExitCode::failure : code;
}

}  // namespace

int run_program(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error of write(), like a full disk
  std::signal(SIGCHLD, SIG_DFL);  // a parent that ignores it hands that on, and children leave no exit status
  reserve_standard_files();
  keep_freed_memory();
  try {
    return int(check_standard_output(run_command_line(argc, argv, all_commands())));
  } catch (const InputError& error) {
    print_err("\n%s\n", error.what());
    return int(ExitCode::bad_input);
  } catch (const Stopped& stopped) {
    print_err("\n%s\n", stopped.what());
    return int(ExitCode::stopped);
  } catch (const std::filesystem::filesystem_error& error) {
    print_err("\nrubble: %s: %s\n", error.path1().c_str(), error.code().message().c_str());
  } catch (const std::bad_alloc&) {
    print_err("\nrubble: out of memory\n");
  } catch (const std::exception& error) {
    print_err("\nrubble: %s\n", error.what());
  }
  return int(ExitCode::failure);
}

}  // namespace rubble
