#include "app/support/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/support/print.h"

namespace rubble {
namespace {

constexpr int kBarWidth = 28;
// From here on nothing is said of the time that is left: what is done then, nobody has counted.
constexpr double kNearlyDone = 0.99;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string format_seconds(double seconds) {
  char text[32];
  if (seconds < 100)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else
    std::snprintf(text, sizeof text, "%d:%02d min", int(seconds) / 60, int(seconds) % 60);
  return text;
}

std::string padded(std::string stage) {
  constexpr std::size_t kWidth = 8;
  if (stage.size() < kWidth) stage.resize(kWidth, ' ');
  return stage;
}

}  // namespace

ProgressStyle choose_progress_style(bool quiet) {
  if (quiet) return ProgressStyle::quiet;
  return isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::lines;
}

void Progress::start(const std::string& stage) {
  stage_ = stage;
  started_ = drawn_ = Clock::now();
  if (style_ == ProgressStyle::lines) print_err("%s ...\n", stage.c_str());
  if (style_ == ProgressStyle::bar) draw(0, "");
}

void Progress::update(double fraction, const std::string& detail) {
  if (style_ == ProgressStyle::quiet) return;
  const double interval = style_ == ProgressStyle::bar ? 0.1 : 10.0;
  if (seconds_since(drawn_) < interval) return;
  drawn_ = Clock::now();
  draw(std::clamp(fraction, 0.0, 1.0), detail);
}

void Progress::draw(double fraction, const std::string& detail) {
  fraction = std::min(fraction, kNearlyDone);  // it is done when finish() says so
  const double elapsed = seconds_since(started_);
  std::string left;
  if (fraction > 0.02 && fraction < kNearlyDone && elapsed > 1.0)
    left = ", about " + format_seconds(elapsed * (1 - fraction) / fraction) + " left";
  if (style_ == ProgressStyle::lines) {
    print_err("%s: %d %%  %s%s\n", stage_.c_str(), int(100 * fraction), detail.c_str(), left.c_str());
    return;
  }
  const int filled = int(fraction * kBarWidth);
  const std::string bar =
      std::string(std::size_t(filled), '#') + std::string(std::size_t(kBarWidth - filled), '.');
  char share[16];
  std::snprintf(share, sizeof share, "%3d %%", int(100 * fraction));
  redraw_line(padded(stage_) + " [" + bar + "] " + share + "  " + detail + left, false);
}

void Progress::finish(const std::string& result) {
  const double elapsed = seconds_since(started_);
  wall_seconds_[stage_] = elapsed;
  if (style_ == ProgressStyle::quiet) return;
  const std::string line = padded(stage_) + " " + result + " (" + format_seconds(elapsed) + ")";
  if (style_ == ProgressStyle::bar) return redraw_line(line, true);
  print_err("%s\n", line.c_str());
}

}  // namespace rubble
