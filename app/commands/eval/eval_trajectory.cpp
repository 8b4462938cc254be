// `rubble eval trajectory`: an estimate against the truth.
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/eval/scores/trajectory_error.h"
#include "app/support/print.h"

namespace rubble {
namespace {

struct TrajectoryRequest {
  std::string estimate, truth;   // TUM or EuRoC files
  int delta = 1;                 // --delta: poses between which relative errors are taken
  double max_difference = 0.01;  // --max-difference: of the stamps of a pair; unit: s
  bool json = false;             // --json
};

std::string span_of(const std::vector<StampedPose>& poses) {
  return std::to_string(poses.front().stamp) + " to " + std::to_string(poses.back().stamp) + " s";
}

// The errors of a comparison know no file: the estimate's is the one to look at.
template <typename Work>
auto with_file(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const InputError& error) {
    std::vector<Diagnostic> named = error.diagnostics();
    for (Diagnostic& d : named)
      if (d.file.empty() && d.key.empty()) d.file = path;
    throw InputError(named);
  }
}

void print_table(const TrajectoryError& e) {
  print_out("pairs                       %d\n", e.pairs);
  print_out("ATE, rigid alignment        %.6f m\n", e.ate_rmse_se3);
  print_out("ATE, aligned with scale     %.6f m (scale %.6f)\n", e.ate_rmse_sim3, e.sim3_scale);
  print_out("RPE, translation            %.6f m\n", e.rpe_trans_rmse);
  print_out("RPE, rotation               %.6f degrees\n", e.rpe_rot_rmse_deg);
}

ExitCode eval_trajectory(const TrajectoryRequest& request) {
  const auto estimate = load_trajectory(request.estimate);
  const auto truth = load_trajectory(request.truth);
  const auto pairs = associate(estimate, truth, request.max_difference);
  if (pairs.empty())
    throw InputError(
        {request.estimate, 0, "", "has no time in common with " + request.truth,
         "stamps within " + std::to_string(request.max_difference) + " s of " + span_of(truth),
         span_of(estimate), "--max-difference allows more"});
  const TrajectoryError error =
      with_file(request.estimate, [&] { return calc_trajectory_error(pairs, request.delta); });
  if (!request.json) {
    print_table(error);
    return ExitCode::done;
  }
  const nlohmann::ordered_json json{{"pairs", error.pairs},
                                    {"ate_rmse_se3_m", error.ate_rmse_se3},
                                    {"ate_rmse_sim3_m", error.ate_rmse_sim3},
                                    {"sim3_scale", error.sim3_scale},
                                    {"rpe_trans_rmse_m", error.rpe_trans_rmse},
                                    {"rpe_rot_rmse_deg", error.rpe_rot_rmse_deg}};
  print_json(json.dump(1) + "\n");
  return ExitCode::done;
}

Action declare_eval_trajectory(CommandLine& line) {
  const auto request = std::make_shared<TrajectoryRequest>();
  line.add("estimate", request->estimate, "The estimate: a TUM or EuRoC file").required();
  line.add("truth", request->truth, "The truth: a TUM or EuRoC file").required();
  line.add("--delta", request->delta, "Number of poses over which relative errors are computed")
      .shows_default();
  line.add("--max-difference", request->max_difference, "Largest time difference of matched poses")
      .shows_default()
      .metavar("SECONDS")
      .non_negative();
  line.add_flag("--json", request->json, "Print the result as JSON");
  return [request] { return eval_trajectory(*request); };
}

}  // namespace

Command eval_trajectory_command() {
  return {"eval", "trajectory", "Absolute and relative errors of a trajectory, as computed by evo",
          declare_eval_trajectory};
}

}  // namespace rubble
