#include "render/lighting/baker.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr std::size_t kAlbedos = 4;  // nodes whose mean albedo is that of a point, at most
constexpr std::size_t kChunk = 256;  // points a job
constexpr std::uint32_t kPlanned = 64;  // the same, where each has rays of its own number
constexpr std::size_t kAtOnce = 200000;  // points of pieces whose light is found at once, and the last piece's
using NodesOfPoint = std::vector<std::uint32_t>;

// Of directions spread evenly, cosine-weighted (Malley's method over a golden-ratio sequence), in an order in which those
// that follow each other go about the same way, for packets: first the steep half, then the other, each once around.
std::vector<Baker::Spoke> make_spokes(std::size_t count) {
  struct Place {
    std::size_t stratum;
    double turn;
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = double(i) * 0.6180339887498949;
    places.push_back({i, turn - std::floor(turn)});
  }
  const auto half = places.begin() + std::ptrdiff_t(count / 2);
  const auto before = [](const Place& a, const Place& b) { return a.turn < b.turn; };
  std::sort(places.begin(), half, before), std::sort(half, places.end(), before);
  std::vector<Baker::Spoke> out;
  for (const Place& p : places) {
    const portable::SinCos a = portable::sincos(2 * portable::kPi * p.turn);
    out.push_back({float(p.stratum), float(a.cos), float(a.sin)});
  }
  return out;
}

// Of each point of a mesh: some of the nodes that are nearest to it, from all over the list.
std::vector<NodesOfPoint> nodes_of_points(const std::vector<std::uint32_t>& nearest_points, std::size_t points) {
  std::vector<NodesOfPoint> out(points);
  for (std::uint32_t i = 0; i < nearest_points.size(); ++i) out[nearest_points[i]].push_back(i);
  for (NodesOfPoint& nodes : out) {
    if (nodes.size() <= kAlbedos) continue;
    for (std::size_t k = 0; k < kAlbedos; ++k) nodes[k] = nodes[k * nodes.size() / kAlbedos];
    nodes.resize(kAlbedos);
  }
  return out;
}

}  // namespace

Baker::Baker(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const BakeOptions& options)
    : scene_(scene),
      light_(light),
      options_(options),
      scene_rays_(rays),
      sheets_(scene),
      first_spokes_(make_spokes(std::min(kFirstRays, std::size_t(options.rays)))),
      spokes_(make_spokes(std::min(kRound, std::size_t(options.rays)))) {
  list_points();
  find_nearest_points();
}

void Baker::list_points() {
  std::size_t count = 0;
  for (const PlacedMesh& placed : scene_.placed) count += scene_.meshes[placed.mesh].bake_points.size();
  points_.reserve(count), places_.reserve(count);
  for (std::size_t piece = 0; piece < scene_.placed.size(); ++piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<BakePoint>& sources = scene_.meshes[placed.mesh].bake_points;
    first_point_.push_back(std::uint32_t(points_.size()));
    for (std::size_t i = 0; i < sources.size(); ++i) {
      Point p;
      p.piece = std::uint32_t(piece), p.source = std::uint32_t(i);
      points_.push_back(p);
      places_.push_back({Vec3f(placed.world_from_mesh * (Vec3(sources[i].position) * placed.scale)),
                         Vec3f(placed.world_from_mesh.rotation.rotate(Vec3(sources[i].normal)))});
    }
  }
  radiance_.resize(points_.size());
}

void Baker::find_nearest_points() {
  nearest_points_.resize(scene_.meshes.size());
  parallel_for(nearest_points_.size(), options_.threads, [&](std::size_t mesh) {
    for (const LightNode& node : scene_.meshes[mesh].light_nodes) {
      const auto& w = node.weights;
      nearest_points_[mesh].push_back(node.points[std::size_t(std::max_element(w.begin(), w.end()) - w.begin())]);
    }
  });
}

void Baker::find_albedos(const AlbedoAt& albedo) {
  std::vector<std::vector<NodesOfPoint>> nodes(scene_.meshes.size());
  parallel_for(nodes.size(), options_.threads, [&](std::size_t mesh) {
    nodes[mesh] = nodes_of_points(nearest_points_[mesh], scene_.meshes[mesh].bake_points.size());
  });
  albedos_.resize(points_.size());
  over_points(0, 0, {}, [&](std::size_t i) {
    const Point& p = points_[i];
    const std::uint32_t mesh = scene_.placed[p.piece].mesh;
    const NodesOfPoint& of_point = nodes[mesh][p.source];
    for (const std::uint32_t k : of_point) {
      const LightNode& node = scene_.meshes[mesh].light_nodes[k];
      albedos_[i] += albedo({p.piece, node.triangle}, node.u, node.v) * (1 / float(of_point.size()));
    }
  });
}

void Baker::update_radiance() {
  for (std::size_t i = 0; i < points_.size(); ++i)
    radiance_[i] = multiply(albedos_[i], points_[i].direct + points_[i].indirect) * (1 / portable::kPiF);
}

template <typename Work>
void Baker::over_points(double from, double to, const std::function<void(double)>& progress, const Work& work) {
  constexpr std::size_t kSlice = 64;  // jobs between two reports
  const std::size_t jobs = (points_.size() + kChunk - 1) / kChunk;
  for (std::size_t first = 0; first < jobs; first += kSlice) {
    const std::size_t last = std::min(first + kSlice, jobs);
    parallel_for(last - first, options_.threads, [&](std::size_t job) {
      const std::size_t begin = (first + job) * kChunk;
      for (std::size_t i = begin; i < std::min(begin + kChunk, points_.size()); ++i) work(i);
    });
    if (progress) progress(from + (to - from) * double(last) / double(jobs));
  }
}

void Baker::mark_closed() {
  for (std::uint32_t& hit : first_hits_)
    if (hit < kNone && !points_[hit].open) hit |= BakeLinks::kClosed;
}

// A point inside a neighbour takes a part of the light of the point that stands in for it.
void Baker::fill_closed() {
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!points_[i].open)
      points_[i].indirect = substitutes_[i] != kNone ? points_[substitutes_[i]].indirect * kContact : Vec3f();
}

void Baker::solve(const AlbedoAt& albedo, const std::function<void(double)>& progress) {
  rays_ = &scene_rays_.solid();
  find_albedos(albedo);
  sky_.resize(points_.size());
  first_hits_.assign(points_.size() * first_spokes_.size(), kNone);
  if (sheets_.any()) first_cleared_.assign(first_hits_.size(), 255);
  if (!light_.far.empty()) far_light_.resize(points_.size()), far_vectors_.resize(points_.size());
  over_points(0, 0.9, progress, [&](std::size_t i) { trace(i); });
  find_substitutes();
  mark_closed();
  for (int bounce = 0; bounce < options_.bounces; ++bounce) {
    update_radiance();
    over_points(0.9, 0.9, progress, [&](std::size_t i) { gather_first(i); });
    fill_closed();
  }
  update_radiance();
  std::vector<Vec3f>().swap(sky_);
}

void Baker::save(CacheWriter& to) const {
  to.put(std::uint64_t(points_.size()));
  for (const Point& p : points_) to.put(Solved{p.direct, p.indirect, p.clearance, p.room, p.open});
  to.put(first_hits_), to.put(first_cleared_), to.put(albedos_), to.put(far_light_), to.put(far_vectors_);
}

bool Baker::restore(CacheReader& from) {
  std::uint64_t count = 0;
  from.get(count);
  if (count != points_.size()) return false;
  for (Point& p : points_) {
    Solved solved{};
    from.get(solved);
    p.direct = solved.direct, p.indirect = solved.indirect;
    p.clearance = solved.clearance, p.room = solved.room, p.open = std::uint8_t(solved.open);
  }
  from.get(first_hits_), from.get(first_cleared_), from.get(albedos_), from.get(far_light_), from.get(far_vectors_);
  const std::size_t far = light_.far.empty() ? 0 : points_.size();
  if (!from.whole() || albedos_.size() != points_.size() || first_hits_.size() != points_.size() * first_spokes_.size() ||
      far_light_.size() != far || far_vectors_.size() != far ||
      first_cleared_.size() != (sheets_.any() ? first_hits_.size() : 0)) {
    for (Point& p : points_) p.open = 0;  // trace() adds to it
    first_cleared_.clear(), far_light_.clear(), far_vectors_.clear();
    return false;
  }
  find_substitutes();
  update_radiance();
  return true;
}

// A few pieces at a time: what is known of a point meanwhile takes hundreds of bytes.
void Baker::light_pieces(const std::vector<std::uint32_t>& pieces, LightTable& nodes) {
  rays_ = &scene_rays_.solid();
  std::vector<Piece> work;
  std::size_t points = 0;
  for (const std::uint32_t number : pieces) {
    const std::uint32_t first = first_point_[number], end = std::uint32_t(end_point(number));
    work.push_back({number, first, end, std::vector<Found>(end - first)});
    points += end - first;
    if (points < kAtOnce && number != pieces.back()) continue;
    light_at_once(work, nodes);
    work.clear(), points = 0;
  }
}

void Baker::light_at_once(std::vector<Piece>& work, LightTable& nodes) const {
  parallel_for(work.size(), options_.threads, [&](std::size_t k) { plan(work[k]); });
  struct Job {
    Piece* piece;
    std::uint32_t begin, end;
  };
  std::vector<Job> jobs;
  for (Piece& piece : work)
    for (std::uint32_t begin = piece.first; begin < piece.end; begin += kPlanned)
      jobs.push_back({&piece, begin, std::min(begin + kPlanned, piece.end)});
  parallel_for(jobs.size(), options_.threads, [&](std::size_t k) {
    for (std::uint32_t i = jobs[k].begin; i < jobs[k].end; ++i) gather(i, jobs[k].piece->of(i));
  });
  parallel_for(work.size(), options_.threads, [&](std::size_t k) {
    smooth(work[k]);
    store_nodes(work[k], nodes);
    std::vector<Found>().swap(work[k].found);
  });
}

void Baker::store_nodes(const Piece& piece, LightTable& nodes) const {
  const PlacedMesh& placed = scene_.placed[piece.number];
  const std::vector<LightNode>& of_mesh = scene_.meshes[placed.mesh].light_nodes;
  for (std::size_t i = 0; i < of_mesh.size(); ++i) {
    Vec3f vector, indirect;
    for (std::size_t k = 0; k < 4; ++k) {
      const Arrived& arrived = piece.found[of_mesh[i].points[k]].arrived;
      vector += arrived.vector * of_mesh[i].weights[k], indirect += arrived.indirect * of_mesh[i].weights[k];
    }
    nodes[placed.first_light + i] = pack_light(vector, indirect);
  }
}

Vec3f Baker::triangle_radiance(const RayScene::Triangle& triangle) const {
  const std::uint32_t mesh = scene_.placed[triangle.placed].mesh;
  Vec3f sum;
  for (const std::uint32_t v : scene_.meshes[mesh].triangles[triangle.source].vertices)
    sum += radiance_[first_point_[triangle.placed] + nearest_points_[mesh][v]] * (1.0f / 3);
  return sum;
}

}  // namespace rubble
