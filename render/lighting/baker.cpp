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

Baker::Baker(const PreparedScene& scene, const RayScene& solid, const LightSet& light, const AlbedoAt& albedo,
             const BakeOptions& options)
    : scene_(scene),
      light_(light),
      options_(options),
      rays_(solid),
      sheets_(scene),
      first_spokes_(make_spokes(std::min(kFirstRays, std::size_t(options.rays)))),
      spokes_(make_spokes(std::min(kRound, std::size_t(options.rays)))) {
  list_points();
  find_nearest_points();
  find_albedos(albedo);
}

void Baker::list_points() {
  for (std::size_t piece = 0; piece < scene_.placed.size(); ++piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<BakePoint>& sources = scene_.meshes[placed.mesh].bake_points;
    first_point_.push_back(std::uint32_t(points_.size()));
    for (std::size_t i = 0; i < sources.size(); ++i) {
      Point p;
      p.position = Vec3f(placed.world_from_mesh * (Vec3(sources[i].position) * placed.scale));
      p.normal = Vec3f(placed.world_from_mesh.rotation.rotate(Vec3(sources[i].normal)));
      p.piece = std::uint32_t(piece), p.source = std::uint32_t(i);
      points_.push_back(p);
    }
  }
  first_hits_.resize(points_.size() * first_spokes_.size());
  if (sheets_.any()) first_cleared_.assign(first_hits_.size(), 255);
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

// The direct light of far lights comes to no pixel but by the nodes.
void Baker::show_far_light() {
  if (light_.far.empty()) return;
  for (std::size_t i = 0; i < points_.size(); ++i)
    points_[i].indirect += far_light_[i], points_[i].vector += far_vectors_[i];
  fill_closed();
}

void Baker::run(const std::function<void(double)>& progress) {
  if (!light_.far.empty()) far_light_.resize(points_.size()), far_vectors_.resize(points_.size());
  over_points(0, 0.4, progress, [&](std::size_t i) { trace(i); });
  find_substitutes();
  for (int bounce = 0; bounce < options_.bounces; ++bounce) {
    update_radiance();
    over_points(0.5, 0.5, progress, [&](std::size_t i) { gather_first(i); });
    fill_closed();
  }
  update_radiance();
  neighbours_.resize(points_.size()), sums_.resize(points_.size()), rounds_.resize(points_.size());
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) { plan(piece); });
  over_points(0.5, 0.85, progress, [&](std::size_t i) { gather(i); });
  std::vector<Point> smoothed = points_;
  over_points(0.85, 0.9, progress, [&](std::size_t i) { smooth(i, smoothed[i]); });
  points_.swap(smoothed);
  fill_closed();
  update_radiance();
  show_far_light();
}

std::vector<BakedLight> Baker::node_light() const {
  std::vector<BakedLight> out(scene_.light_nodes);
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vec3f vector, indirect;
      for (std::size_t k = 0; k < 4; ++k) {
        const Point& p = points_[first_point_[piece] + nodes[i].points[k]];
        vector += p.vector * nodes[i].weights[k], indirect += p.indirect * nodes[i].weights[k];
      }
      out[placed.first_light + i] = pack_light(vector, indirect);
    }
  });
  return out;
}

std::vector<Vec3f> Baker::triangle_radiance() const {
  std::vector<Vec3f> out;
  out.reserve(rays_.triangles().size());
  for (const RayScene::Triangle& t : rays_.triangles()) {
    const std::uint32_t mesh = scene_.placed[t.placed].mesh;
    Vec3f sum;
    for (const std::uint32_t v : scene_.meshes[mesh].triangles[t.source].vertices)
      sum += radiance_[first_point_[t.placed] + nearest_points_[mesh][v]] * (1.0f / 3);
    out.push_back(sum);
  }
  return out;
}

}  // namespace rubble
