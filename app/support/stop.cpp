#include "app/support/stop.h"

#include <csignal>
#include <ctime>

#include "kernel/base/error.h"

namespace rubble {
namespace {

volatile std::sig_atomic_t stop_signal = 0;
volatile std::sig_atomic_t first_second = 0;

// `timeout` and shells send one stop twice, to the process and to its group.
void on_signal(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (stop_signal == 0) {
    stop_signal = signal;
    first_second = std::sig_atomic_t(now.tv_sec);
  } else if (now.tv_sec - first_second > 1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, on_signal);
  // A terminal that closes stops the run as politely, but not one begun with `nohup`.
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool stop_requested() { return stop_signal != 0; }

void throw_if_stopped(const std::string& folder) {
  if (!stop_requested()) return;
  throw Stopped("stopped by a signal" +
                (folder.empty() ? "" : "; `rubble resume " + folder + "` continues"));
}

}  // namespace rubble
