#include "app/search/program_agent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/report/html_text.h"
#include "app/search/agent_process.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGrace = 2;               // to end by itself; unit: s
constexpr std::size_t kMostReports = 100;  // in one answer

// Little-endian 16-bit numbers in base64.
std::string pack(const std::vector<float>& values, double unit, bool zero_where_infinite) {
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (const float value : values) {
    const bool none = zero_where_infinite && !std::isfinite(value);
    const auto whole = std::uint16_t(none ? 0 : std::clamp(std::floor(double(value) / unit + 0.5), 0.0, 65535.0));
    bytes.push_back(char(whole & 0xff)), bytes.push_back(char(whole >> 8));
  }
  return base64(bytes);
}

Json list(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

std::string begin_line(const SearchBriefing& b) {
  const SearchRules& r = b.rules;
  const Intrinsics k = search_camera(r);
  Json line;
  line["type"] = "start", line["version"] = kSearchVersion, line["seed"] = b.seed;
  line["victims"] = b.victims, line["reports"] = b.reports, line["report_within"] = r.report_within;
  line["radius"] = r.radius, line["speed"] = r.speed, line["turn_rate"] = r.turn_rate;
  line["period"] = r.period, line["time_limit"] = r.time_limit;
  line["camera"] = {{"width", r.width}, {"height", r.height}, {"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx},
                    {"cy", k.cy}, {"max_range", r.max_range}};
  line["bounds"] = {list(b.bounds.min), list(b.bounds.max)};
  return line.dump();
}

std::string observation_line(const SearchObservation& seen) {
  Json line;
  line["type"] = "observation", line["time"] = seen.time;
  line["position"] = list(seen.pose.position), line["yaw"] = seen.pose.yaw;
  line["stopped"] = seen.stopped, line["found"] = seen.found, line["reports_left"] = seen.reports_left;
  line["depth_mm"] = pack(seen.depth, 1e-3, true);
  line["thermal_ck"] = pack(seen.thermal, 1e-2, false);
  return line.dump();
}

[[noreturn]] void fail_answer(const std::string& expected, const std::string& line) {
  throw AgentFailure{"the agent's answer is not understood: expected " + expected + ", found " + line.substr(0, 200)};
}

double number_of(const Json& value, const std::string& name, const std::string& line) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) fail_answer("finite numbers in `" + name + "`", line);
  return value.get<double>();
}

Vec3 point_of(const Json& value, const std::string& name, const std::string& line) {
  if (!value.is_array() || value.size() != 3) fail_answer("three numbers in `" + name + "`", line);
  Vec3 point;
  for (int k = 0; k < 3; ++k) point[k] = number_of(value[std::size_t(k)], name, line);
  return point;
}

SearchAction read_action(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) fail_answer("a JSON object in one line", line);
  SearchAction action;
  for (const auto& [name, value] : json.items()) {
    if (name == "velocity") {
      action.command.velocity = point_of(value, name, line);
    } else if (name == "turn") {
      action.command.turn = number_of(value, name, line);
    } else if (name == "report") {
      if (!value.is_array() || value.size() > kMostReports) fail_answer("a list of at most 100 points in `report`", line);
      for (const Json& point : value) action.reports.push_back(point_of(point, name, line));
    } else if (name == "done") {
      if (!value.is_boolean()) fail_answer("true or false in `done`", line);
      action.done = value.get<bool>();
    } else {
      fail_answer("only velocity, turn, report and done, not `" + name + "`", line);
    }
  }
  return action;
}

class ProgramAgent : public SearchAgent {
 public:
  ProgramAgent(const ProgramAgentOptions& options, const SearchBriefing& briefing)
      : deadline_(options.deadline), first_(begin_line(briefing)), process_(options.command, options.log) {}

  SearchAction act(const SearchObservation& seen) override {
    // The first answer comes late where an interpreter has much to load.
    const double deadline = first_.empty() ? deadline_ : 3 * deadline_;
    if (!first_.empty()) process_.write_line(first_, deadline);
    first_.clear();
    process_.expect_silence();
    process_.write_line(observation_line(seen), deadline);
    return read_action(process_.read_line(deadline));
  }

  void end(const SearchScore& score) override {
    Json line;
    line["type"] = "end", line["found"] = score.found, line["victims"] = score.victims;
    line["false_reports"] = score.false_reports, line["coverage"] = score.coverage, line["spl"] = score.spl;
    try {
      process_.write_line(line.dump(), deadline_);
      process_.finish(kGrace);
    } catch (const AgentFailure&) {  // it has what it earned
    }
  }

 private:
  double deadline_;
  std::string first_;
  AgentProcess process_;
};

}  // namespace

std::unique_ptr<SearchAgent> start_program_agent(const ProgramAgentOptions& options, const SearchBriefing& briefing) {
  return std::make_unique<ProgramAgent>(options, briefing);
}

}  // namespace rubble
