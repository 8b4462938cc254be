// `rubble eval trajectory`: an estimate against the truth.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/eval/scores/trajectory_doubts.h"
#include "app/eval/scores/trajectory_error.h"
#include "app/provenance/earlier_files.h"
#include "app/report/svg_plot.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

struct TrajectoryRequest {
  std::string estimate, truth;   // files
  std::string columns;           // --columns: names of the columns of both; empty: the files name them
  int delta = 1;                 // --delta: poses between which relative errors are taken
  double max_difference = 0.01;  // --max-difference: of the stamps of a pair; unit: s
  std::string times;             // --times: stamps of a file without any
  std::vector<double> segments;  // --segments: lengths for KITTI's errors; unit: m
  std::string plot;              // --plot: an SVG file
  bool json = false;             // --json
};

std::string span_of(const std::vector<StampedPose>& poses) {
  return fixed_text(poses.front().stamp, 6) + " to " + fixed_text(poses.back().stamp, 6) + " s";  // of any epoch
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

// What a file was read as belongs to the result, but not among the numbers that programs read.
void describe(const std::string& path, const RecordedTrajectory& track) {
  print_err("%s: %zu poses, read as %s\n", path.c_str(), track.poses.size(),
            track.format.c_str());
  for (const std::string& note : track.notes)
    print_err("%s: %s\n", path.c_str(), note.c_str());
}

void add_stamps(const std::string& times, ComparedTracks& tracks) {
  if (times.empty()) return;
  if (tracks.estimate.has_stamps && tracks.truth.has_stamps)
    throw InputError({"", 0, "--times", "has nothing to stamp", "a KITTI file without stamps", "stamps in both files", ""});
  if (!tracks.estimate.has_stamps) stamp_poses(times, tracks.estimate_path, tracks.estimate);
  if (!tracks.truth.has_stamps) stamp_poses(times, tracks.truth_path, tracks.truth);
}

// The paths from above and the error by time; of KITTI's world, which is an optical frame, Z is ahead and Y down.
std::string make_plots(const std::vector<PosePair>& pairs, const RecordedTrajectory& truth) {
  const bool optical = truth.optical_world;
  const auto from_above = [optical](const Vec3& p) { return PlotPoint{p.x, optical ? p.z : p.y, "", false}; };
  PlotLine true_path{"truth", {}}, path{"estimate, aligned", {}}, errors{"error", {}};
  for (const AlignedPair& pair : align_pairs(pairs)) {
    true_path.points.push_back(from_above(pair.truth));
    path.points.push_back(from_above(pair.estimate));
    errors.points.push_back({pair.stamp, distance(pair.estimate, pair.truth), "", false});
  }
  return make_svg_file({make_lines("x (m)", optical ? "z (m)" : "y (m)", {true_path, path}, true),
                        make_lines(truth.has_stamps ? "time (s)" : "pose", "error of position (m)", {errors})});
}

void print_segments(const std::vector<SegmentError>& segments) {
  for (const SegmentError& s : segments)
    print_out("KITTI, segments of %-8.6g %.6f %%, %.6f degrees/m (%d segments)\n", s.length, s.trans_percent, s.rot_deg_per_m,
              s.segments);
}

void print_table(const TrajectoryError& e) {
  print_out("pairs                       %d\n", e.pairs);
  print_out("ATE, rigid alignment        %.6f m\n", e.ate_rmse_se3);
  print_out("  mean, median, maximum     %.6f, %.6f, %.6f m\n", e.ate_se3.mean, e.ate_se3.median, e.ate_se3.max);
  print_out("ATE, aligned with scale     %.6f m (scale %.6f)\n", e.ate_rmse_sim3, e.sim3_scale);
  print_out("RPE, translation            %.6f m\n", e.rpe_trans_rmse);
  print_out("RPE, rotation               %.6f degrees\n", e.rpe_rot_rmse_deg);
}

void check_plot_name(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".svg")
    throw InputError({path, 0, "--plot", "the name says another format", "a file that ends with .svg",
                      ending.empty() ? "no ending" : ending, ""});
  refuse_recorded_file(path, "--plot");
}

ExitCode eval_trajectory(const TrajectoryRequest& request) {
  if (!request.plot.empty()) check_plot_name(request.plot);
  ComparedTracks tracks{request.estimate, request.truth,
                              load_recorded_trajectory(request.estimate, request.columns),
                              load_recorded_trajectory(request.truth, request.columns)};
  describe(request.estimate, tracks.estimate);
  describe(request.truth, tracks.truth);
  add_stamps(request.times, tracks);
  check_comparable(tracks, request.max_difference);
  const auto pairs = associate(tracks.estimate.poses, tracks.truth.poses, request.max_difference);
  if (pairs.empty())
    throw InputError(
        {request.estimate, 0, "", "has no time in common with " + request.truth,
         "stamps within " + plain_text(request.max_difference) + " s of " + span_of(tracks.truth.poses),
         span_of(tracks.estimate.poses), explain_no_overlap(tracks)});
  const TrajectoryError error =
      with_file(request.estimate, [&] { return calc_trajectory_error(pairs, request.delta); });
  std::vector<SegmentError> segments;
  for (const double length : request.segments) {
    segments.push_back(calc_segment_error(pairs, length));
    if (segments.back().segments == 0)
      print_err("warning: the truth has no segment of %g m\n", length);
  }
  if (!request.plot.empty()) write_text_file(request.plot, make_plots(pairs, tracks.truth));
  for (const std::string& doubt : find_doubts(tracks, pairs))
    print_err("warning: %s\n", doubt.c_str());
  if (!request.json) {
    print_table(error);
    print_segments(segments);
    return ExitCode::done;
  }
  nlohmann::ordered_json json{{"pairs", error.pairs},
                                    {"ate_rmse_se3_m", error.ate_rmse_se3},
                                    {"ate_mean_se3_m", error.ate_se3.mean},
                                    {"ate_median_se3_m", error.ate_se3.median},
                                    {"ate_max_se3_m", error.ate_se3.max},
                                    {"ate_rmse_sim3_m", error.ate_rmse_sim3},
                                    {"sim3_scale", error.sim3_scale},
                                    {"rpe_trans_rmse_m", error.rpe_trans_rmse},
                                    {"rpe_rot_rmse_deg", error.rpe_rot_rmse_deg}};
  for (const SegmentError& s : segments)
    json["kitti"].push_back({{"length_m", s.length},
                             {"segments", s.segments},
                             {"trans_percent", s.trans_percent},
                             {"rot_deg_per_m", s.rot_deg_per_m}});
  print_json(json.dump(1) + "\n");
  return ExitCode::done;
}

Action declare_eval_trajectory(CommandLine& line) {
  const auto request = std::make_shared<TrajectoryRequest>();
  line.add("estimate", request->estimate, "The estimate: a TUM, EuRoC or KITTI file, or one that names its columns")
      .required()
      .metavar("FILE");
  line.add("truth", request->truth, "The ground truth, in one of these formats").required().metavar("FILE");
  line.add("--delta", request->delta, "Number of poses over which relative errors are computed")
      .shows_default();
  line.add("--max-difference", request->max_difference, "Largest time difference of matched poses")
      .shows_default()
      .metavar("SECONDS")
      .non_negative();
  line.add("--columns", request->columns, "Names of the columns of a file that does not name them: "
                                          "t,x,y,z,qx,qy,qz,qw")
      .metavar("NAMES");
  line.add("--times", request->times, "Stamps of the poses of a KITTI file, one a line, as KITTI's times.txt")
      .metavar("FILE");
  line.add("--segments", request->segments, "Lengths for the errors of KITTI's benchmark: 5,10,20")
      .separated_by(',')
      .metavar("METRES")
      .positive();
  line.add("--plot", request->plot, "Draw both paths from above, and the error by time, as an SVG file").metavar("FILE");
  line.add_flag("--json", request->json, "Print the result as JSON");
  return [request] { return eval_trajectory(*request); };
}

}  // namespace

Command eval_trajectory_command() {
  return {"eval", "trajectory", "Score a trajectory: absolute and relative errors, as computed by evo",
          declare_eval_trajectory};
}

}  // namespace rubble
