#include "render/devices/software/software_raster.h"

#include <algorithm>

namespace rubble {

namespace {

constexpr int kBandRows = 32;
constexpr std::uint32_t kJobClusters = 48;
constexpr std::size_t kJobsATime = 64;  // so that triangles stay in the processor's cache until they are filled

}  // namespace

// A part of the runs, and what came of it.
struct SoftwareRaster::Job {
  std::size_t first_run = 0, last_run = 0;
  std::vector<TriangleRecord> triangles;
  std::vector<std::vector<std::uint32_t>> bands;  // which triangles touch a band
};

SoftwareRaster::SoftwareRaster(const PreparedScene& scene, const std::vector<ClusterShapes>& shapes,
                               const TriangleNames& names, ThreadPool& pool)
    : scene_(scene), shapes_(shapes), names_(names), pool_(pool) {}

SoftwareRaster::~SoftwareRaster() = default;

void SoftwareRaster::begin(const ViewProjection& view) {
  view_ = &view;
  const std::size_t pixels = std::size_t(view.intrinsics.width * view.intrinsics.height);
  depth_.resize(pixels);
  ids_.resize(pixels);
  constexpr std::size_t kPart = 1 << 17;  // pixels
  pool_.run(int((pixels + kPart - 1) / kPart), 1, [&](int begin, int end) {
    const std::size_t first = std::size_t(begin) * kPart;
    const std::size_t last = std::min(std::size_t(end) * kPart, pixels);
    std::fill(depth_.begin() + std::ptrdiff_t(first), depth_.begin() + std::ptrdiff_t(last), 0.0f);
    std::fill(ids_.begin() + std::ptrdiff_t(first), ids_.begin() + std::ptrdiff_t(last), 0u);
  });
}

void SoftwareRaster::draw(const std::vector<ClusterRun>& runs) {
  runs_ = &runs;
  const int bands = (view_->intrinsics.height + kBandRows - 1) / kBandRows;
  for (std::size_t run = 0; run < runs.size();) {
    for (job_count_ = 0; job_count_ < kJobsATime && run < runs.size(); ++job_count_) {
      if (job_count_ == jobs_.size()) jobs_.push_back(std::make_unique<Job>());
      Job& job = *jobs_[job_count_];
      job.first_run = run;
      for (std::uint32_t clusters = 0; run < runs.size() && clusters < kJobClusters; ++run)
        clusters += runs[run].cluster_count;
      job.last_run = run;
    }
    pool_.run(int(job_count_), 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) set_up(std::size_t(i));
    });
    pool_.run(bands, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) fill(std::size_t(i));
    });
  }
}

void SoftwareRaster::set_up(std::size_t index) {
  Job& job = *jobs_[index];
  job.triangles.clear();
  for (std::size_t r = job.first_run; r < job.last_run; ++r) {
    const ClusterRun& run = (*runs_)[r];
    const PlacedMesh& piece = scene_.placed[run.placed];
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    const MeshView view(*view_, piece.world_from_mesh, piece.scale);
    for (std::uint32_t c = run.first_cluster; c < run.first_cluster + run.cluster_count; ++c)
      set_up_cluster(shapes_[piece.mesh], c, view, run.placed,
                     &names_.name_of_triangle[names_.first_triangle[piece.mesh]] + mesh.clusters[c].first_triangle,
                     job.triangles);
  }
  const int height = view_->intrinsics.height;
  job.bands.resize(std::size_t((height + kBandRows - 1) / kBandRows));
  for (auto& band : job.bands) band.clear();
  for (std::size_t i = 0; i < job.triangles.size(); ++i) {
    const TriangleRecord& t = job.triangles[i];
    const auto [low, high] = std::minmax({t.y[0], t.y[1], t.y[2]});
    const int first = std::max(low >> 8, 0) / kBandRows;
    const int last = std::min(high >> 8, height - 1) / kBandRows;
    for (int band = first; band <= last; ++band)
      job.bands[std::size_t(band)].push_back(std::uint32_t(i));
  }
}

void SoftwareRaster::fill(std::size_t band) {
  const int first_row = int(band) * kBandRows;
  const RasterTarget target{depth_.data(), ids_.data(), view_->intrinsics.width, first_row,
                            std::min(first_row + kBandRows, view_->intrinsics.height)};
  for (std::size_t j = 0; j < job_count_; ++j) {
    const Job& job = *jobs_[j];
    const std::vector<std::uint32_t>& list = job.bands[band];
    constexpr std::size_t kAhead = 6;  // what memory needs to bring a record
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i + kAhead < list.size()) __builtin_prefetch(&job.triangles[list[i + kAhead]]);
      fill_triangle(job.triangles[list[i]], target);
    }
  }
}

}  // namespace rubble
