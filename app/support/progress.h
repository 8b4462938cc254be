// Progress of one stage of a run, for a person: a bar that redraws itself on a terminal, a plain
// line at the start and the end otherwise. Writes to standard error; standard output is for
// results.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace rubble {

enum class ProgressStyle { bar, lines, quiet };

// A bar when standard error is a terminal, lines otherwise; quiet when asked.
ProgressStyle choose_progress_style(bool quiet);

class Progress {
 public:
  explicit Progress(ProgressStyle style) : style_(style) {}

  void start(const std::string& stage);
  // fraction: 0 to 1; detail: a few words such as "layer 2 of 4". Cheap enough to call every step.
  void update(double fraction, const std::string& detail);
  // Ends the stage; `result` says what came of it.
  void finish(const std::string& result);

  // Wall seconds of each finished stage, for the part of the manifest that is not reproducible.
  const std::map<std::string, double>& wall_seconds() const { return wall_seconds_; }

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double fraction, const std::string& detail);

  ProgressStyle style_;
  std::string stage_;
  Clock::time_point started_, drawn_;
  std::map<std::string, double> wall_seconds_;
};

}  // namespace rubble
