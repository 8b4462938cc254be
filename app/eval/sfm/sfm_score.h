// How good a reconstruction by structure from motion is, against the true cameras.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/eval/scores/alignment.h"
#include "io/datasets/colmap_model.h"

namespace rubble {

// The true cameras of a dataset, in the order of time.
struct SfmGroundTruth {
  ColmapModel model;                     // colmap/sparse of the dataset
  std::vector<Pose> world_from_optical;  // one per image
};

// Throws InputError for a dataset without outputs.colmap.
SfmGroundTruth load_sfm_ground_truth(const std::string& dataset);

// One model of a reconstruction: a part of the track that hangs together. Models share neither
// frame nor scale, so each is aligned by itself.
struct SfmSegment {
  ColmapModel model;        // as it was read, in its own frame and scale
  std::vector<int> frames;  // index into the truth, one per image of the model
  // Umeyama's, from the positions: for errors of the trajectory. Nothing where they are on one
  // line.
  std::optional<Similarity> by_positions;
  // From positions and directions of view, which hold the turn about a straight track, too: for the
  // points. Nothing for less than two different positions.
  std::optional<Similarity> by_poses;

  const std::optional<Similarity>& for_positions() const {
    return by_positions ? by_positions : by_poses;
  }
};

// The model in `folder`, or those in its numbered subfolders, as COLMAP's mapper leaves them; by
// the number of their images, most first. Throws InputError for: no model, a model without an
// image, an image that the truth does not have or that a model has twice.
std::vector<SfmSegment> load_segments(const std::string& folder, const SfmGroundTruth& truth);

// Brings points from the frame of a model, the largest in `folder`, to the world. Throws InputError
// when its cameras do not determine that.
void align_to_world(const std::string& folder, const SfmGroundTruth& truth,
                    std::vector<Vec3>& points);

// Least squares over the centres of the cameras and the ends of their three axes, each as long as
// the centres are apart (root mean square of the true ones about their mean).
std::optional<Similarity> align_poses(const std::vector<Pose>& from, const std::vector<Pose>& to);

struct SfmScore {
  int frames = 0;      // length of the sequence
  int segments = 0;    // models
  int registered = 0;  // frames that any model has
  // Frames whose position, in the largest model that has them, is within `bound` of the truth once
  // that model is aligned by positions, or by poses where positions leave it undetermined.
  int on_track = 0;
  std::int64_t points = 0;  // of all models
  double reprojection = 0;  // mean of the points' own; unit: pixel
  // Over the registered frames, each by its own model; nothing when no model could be aligned.
  std::optional<double> ate_rmse;  // unit: m
  // Between frames that follow one another in a model, scaled as aligned; unit: m, degree
  std::optional<double> rpe_trans_rmse, rpe_rot_rmse_deg;

  double on_track_percent() const { return 100.0 * on_track / frames; }
};

// bound: > 0; unit: m
SfmScore calc_sfm_score(const std::vector<SfmSegment>& segments, const SfmGroundTruth& truth,
                        double bound);

// All points, in the world of the truth; those of models that could not be aligned are left out.
std::vector<Vec3> align_points_of(const std::vector<SfmSegment>& segments);

}  // namespace rubble
