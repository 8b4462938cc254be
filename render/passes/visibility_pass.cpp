#include "render/passes/visibility_pass.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr std::size_t kJobPieces = 32;

}  // namespace

VisibilityPass::VisibilityPass(const PreparedScene& scene, TriangleRaster& raster, const VisibilityOptions& options,
                               ThreadPool& pool)
    : scene_(scene),
      options_(options),
      raster_(raster),
      pool_(pool),
      shown_(scene.cluster_flags, 0),
      drawn_(scene.cluster_flags, 0) {}

std::uint32_t VisibilityPass::choose_level(const PlacedMesh& piece, float z, double focal) const {
  const auto& levels = scene_.meshes[piece.mesh].levels;
  if (options_.coarse_below <= 0 || z < piece.radius) return 0;
  // The mean side of a triangle if they covered a sphere of the piece's size evenly.
  const double size = 2 * double(piece.radius) * focal / double(z);
  std::uint32_t level = 0;
  while (level + 1 < levels.size() &&
         1.8 * size / std::sqrt(double(levels[level].triangle_count)) < options_.coarse_below)
    ++level;
  return level;
}

void VisibilityPass::find_candidates(const ViewProjection& view) {
  const ViewVolume volume(view);
  candidates_.clear();
  const Mat3f turn{{Vec3f(view.optical_from_world.rotation.matrix().rows[0]),
                    Vec3f(view.optical_from_world.rotation.matrix().rows[1]),
                    Vec3f(view.optical_from_world.rotation.matrix().rows[2])}};
  const Vec3f shift(view.optical_from_world.translation);
  const double focal = std::max(view.intrinsics.fx, view.intrinsics.fy);
  for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (!piece.there) continue;
    const Vec3f c = turn * piece.centre + shift;
    if (!volume.sphere_in_view(c, piece.radius)) continue;
    candidates_.push_back({{i, choose_level(piece, c.z, focal)}, norm(c) - piece.radius * 0.5f});
  }
  // Near ones first, so that they hide the others' fragments; ties in order of placing.
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
}

void VisibilityPass::add_piece(const Candidate& candidate, const ViewProjection& view,
                               const ViewVolume& volume, bool second, Chosen& chosen) {
  const PlacedMesh& piece = scene_.placed[candidate.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const PreparedLevel& level = mesh.levels[candidate.level];
  const Pose optical_from_mesh = view.optical_from_world * piece.world_from_mesh;
  const Mat3 r = optical_from_mesh.rotation.matrix();
  const Mat3f turn{{Vec3f(r.rows[0] * piece.scale), Vec3f(r.rows[1] * piece.scale),
                    Vec3f(r.rows[2] * piece.scale)}};
  const Vec3f shift(optical_from_mesh.translation);
  const float scale = float(piece.scale);
  const auto box_shows = [&](const Vec3f& centre, const Vec3f& half) {
    const Mat3f sides{{turn.column(0) * half.x, turn.column(1) * half.y, turn.column(2) * half.z}};
    return volume.box_may_show(centre, sides, pyramid_);
  };
  if (second && !box_shows(turn * mesh.centre + shift, mesh.half)) {
    std::fill_n(shown_.begin() + piece.first_flag, mesh.levels[0].cluster_count, std::uint8_t(0));
    return;
  }
  const Vec3f eye(optical_from_mesh.inverse().translation * (1 / piece.scale));
  const bool whole = candidate.level > 0;  // coarse levels are small: all or nothing
  bool running = false;
  const std::uint32_t step = whole ? level.cluster_count : 1;
  for (std::uint32_t k = 0; k < level.cluster_count; k += step) {
    const Cluster& c = mesh.clusters[level.first_cluster + k];
    const std::size_t flag = piece.first_flag + k;
    bool wanted = true;
    if (!whole) {
      const Vec3f centre = turn * c.centre + shift;
      wanted = !faces_away(eye, c.centre, c.radius, c.cone_axis, c.cone_cosine) &&
               volume.sphere_in_view(centre, c.radius * scale) &&
               (!second || box_shows(centre, c.half));
    }
    if (second) {
      shown_[flag] = wanted;
      wanted = wanted && !drawn_[flag];
    } else {
      wanted = wanted && (shown_[flag] || !have_history_);
    }
    drawn_[flag] |= std::uint8_t(wanted);
    if (wanted) {
      if (!running) chosen.runs.push_back({candidate.placed, level.first_cluster + k, 0});
      chosen.runs.back().cluster_count += step;
      chosen.triangles += whole ? level.triangle_count : c.triangle_count;
    }
    running = wanted;
  }
}

void VisibilityPass::choose(const ViewProjection& view, bool second) {
  const ViewVolume volume(view);
  const bool unknown = !second && options_.occlusion_culling && !have_history_;
  const std::size_t count = candidates_.size();
  const std::size_t jobs = unknown ? 1 : (count + kJobPieces - 1) / kJobPieces;
  chosen_.resize(std::max(chosen_.size(), jobs));
  pool_.run(int(jobs), 1, [&](int begin, int end) {
    for (int job = begin; job < end; ++job) {
      Chosen& chosen = chosen_[std::size_t(job)];
      chosen.runs.clear();
      chosen.triangles = 0;
      const std::size_t last = unknown ? count : (std::size_t(job) + 1) * kJobPieces;
      for (std::size_t i = std::size_t(job) * kJobPieces; i < std::min(last, count); ++i) {
        add_piece(candidates_[i], view, volume, second, chosen);
        if (unknown && chosen.triangles > kFirstBatch) break;
      }
    }
  });
  runs_.clear();
  run_triangles_ = 0;
  for (std::size_t job = 0; job < jobs; ++job) {
    runs_.insert(runs_.end(), chosen_[job].runs.begin(), chosen_[job].runs.end());
    run_triangles_ += chosen_[job].triangles;
  }
}

void VisibilityPass::draw(const ViewProjection& view) {
  find_candidates(view);
  std::fill(drawn_.begin(), drawn_.end(), std::uint8_t(0));
  const bool cull = options_.occlusion_culling;
  if (!cull) have_history_ = false;
  raster_.begin(view);
  chosen_by_raster_ = cull && raster_.draw_what_shows({candidates_.begin(), candidates_.end()});
  if (chosen_by_raster_) return raster_.finish();
  choose(view, false);
  counts_ = {run_triangles_, run_triangles_};
  raster_.draw(runs_);
  if (cull) {
    pyramid_.build(raster_.depth_so_far().data(), view.intrinsics.width, view.intrinsics.height);
    choose(view, true);
    counts_.triangles += run_triangles_;
    have_history_ = true;
    if (!runs_.empty()) raster_.draw(runs_);
  }
  raster_.finish();
}

VisibilityPass::Counts VisibilityPass::counts() const {
  if (!chosen_by_raster_) return counts_;
  const std::size_t triangles = raster_.read_triangles();
  return {triangles, triangles};
}

}  // namespace rubble
