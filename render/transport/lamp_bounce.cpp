#include "render/transport/lamp_bounce.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr float kMostAgain = 0.6f;   // share of light that comes back from a bounce, at most

Vec3f colour_of(const AirTransfer::Colour& c) { return {c.c[0], c.c[1], c.c[2]}; }

// What is lit in neither table takes no memory in the second one, either.
void copy_changed(const LightTable& from, LightTable& to) {
  constexpr std::size_t kChunk = 512;  // a page of memory
  if (to.size() != from.size()) to = LightTable(from.size());
  for (std::size_t i = 0; i < from.size(); i += kChunk) {
    const std::size_t count = std::min(kChunk, from.size() - i);
    if (std::memcmp(&from[i], &to[i], count * sizeof(BakedLight)) != 0) std::copy_n(&from[i], count, &to[i]);
  }
}

}  // namespace

LampBounce::LampBounce(const PreparedScene& scene, const BakeLinks& links, const std::vector<std::uint32_t>& first_point,
                       ThreadPool& pool)
    : scene_(scene), links_(links), first_point_(first_point), pool_(pool) {
  const std::size_t points = links_.places.size();
  lit_.resize(points / 64 + 1);
  radiance_.resize(points), once_.resize(points), arrived_.resize(points);
  point_shows_.resize(points), node_shows_.resize(scene.light_nodes);
  is_seen_.resize(scene.placed.size());
}

std::size_t LampBounce::count_points(std::uint32_t piece) const {
  return scene_.meshes[scene_.placed[piece].mesh].bake_points.size();
}

template <typename Work>
void LampBounce::for_seen(const Work& work) {
  pool_.run(int(seen_.size()), 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::size_t first = first_point_[seen_[std::size_t(k)]];
      const std::size_t count = count_points(seen_[std::size_t(k)]);
      for (std::size_t i = first; i < first + count; ++i) work(i);
    }
  });
}

void LampBounce::light_points() {
  for_seen([&](std::size_t i) { radiance_[i] = Light(); });  // of the lamp before
  for (const std::uint32_t piece : seen_) is_seen_[piece] = 0;
  seen_ = reach_->seen();
  for (const std::uint32_t piece : seen_) is_seen_[piece] = 1;
  const PlacedLamp& lamp = reach_->lamp();
  for_seen([&](std::size_t i) {
    const auto& [position, normal] = links_.places[i];
    const Vec3f way = position - lamp.position;
    const float facing = -dot(normal, way), away2 = dot(way, way);
    if (facing <= 0 || away2 > LampReach::kReach * LampReach::kReach || away2 < 1e-6f) return;
    const float away = std::sqrt(away2);
    if (!reach_->shines_on(way, away)) return;
    const float kept = LampReach::kept_at(away) * quick::exp(-extinction_ * away) * facing / (away * portable::kPiF);
    const Vec3f light = multiply(links_.albedos[i], lamp.illuminance(lamp.position, position)) * kept;
    radiance_[i].c = AirTransfer::Four{light.x, light.y, light.z, 0};
  });
}

void LampBounce::show_node(std::uint32_t placed, std::uint32_t node) {
  std::uint8_t& shows = node_shows_[scene_.placed[placed].first_light + node];
  if (shows) return;
  shows = 1;
  shown_nodes_.push_back({placed, node});
  for (const std::uint32_t p : scene_.meshes[scene_.placed[placed].mesh].light_nodes[node].points) {
    const std::uint32_t point = first_point_[placed] + p;
    if (point_shows_[point]) continue;
    point_shows_[point] = 1;
    shown_points_.push_back(point);
  }
}

void LampBounce::find_shown(const std::vector<Shown>& shown) {
  for (const ShownNode& n : shown_nodes_) node_shows_[scene_.placed[n.placed].first_light + n.node] = 0;
  for (const std::uint32_t point : shown_points_) point_shows_[point] = 0;
  shown_nodes_.clear(), shown_points_.clear();
  for (const Shown& s : shown) {
    if (!is_seen_[s.placed]) continue;
    const PreparedTriangle& t = scene_.meshes[scene_.placed[s.placed].mesh].triangles[s.triangle];
    if (t.light_steps < 2) {
      for (const std::uint32_t vertex : t.vertices) show_node(s.placed, vertex);
    } else if (!node_shows_[scene_.placed[s.placed].first_light + t.first_node]) {
      for (std::uint32_t i = 0; i < light_node_count(t.light_steps); ++i) show_node(s.placed, t.first_node + i);
    }
  }
}

void LampBounce::add_shown_to_changed() {
  std::vector<LightRange> of_piece(scene_.placed.size(), LightRange{std::size_t(-1), 0});
  for (const ShownNode& n : shown_nodes_) {
    const std::size_t at = scene_.placed[n.placed].first_light + n.node;
    LightRange& range = of_piece[n.placed];
    range = {std::min(range.begin, at), std::max(range.end, at + 1)};
  }
  for (const LightRange& range : of_piece)
    if (range.end > 0) changed_.push_back(range);
}

// What the air leaves of light between two points.
float LampBounce::passes(std::size_t from, std::size_t to) const {
  return quick::exp(-extinction_ * distance(links_.places[from].position, links_.places[to].position));
}

void LampBounce::mark_lit() {
  std::fill(lit_.begin(), lit_.end(), 0);
  for (const std::uint32_t piece : seen_) {
    const std::size_t first = first_point_[piece];
    for (std::size_t i = first; i < first + count_points(piece); ++i)
      if (radiance_[i].c[1] > 0) lit_[i / 64] |= std::uint64_t(1) << (i % 64);
  }
}

// By every other ray. Most end where the lamp does not shine, which the bits say without a look at the light.
Vec3f LampBounce::gather_colour(std::size_t point) const {
  const std::uint32_t* links = links_.of(point);
  Light sum;
  int rays = 0;
  for (std::size_t k = 0; k < links_.per_point; k += 2) {
    const std::uint32_t sender = links_.sender(links[k]);
    rays += sender != BakeLinks::kNone;
    if (sender >= BakeLinks::kNone) continue;  // or dark
    if (!(lit_[sender / 64] >> (sender % 64) & 1)) continue;
    const Light& light = radiance_[sender];
    const float share = extinction_ > 0 ? passes(point, sender) : 1;
    sum.c += light.c * share;
  }
  const float scale = rays > 0 ? portable::kPiF / float(rays) : 0;
  return colour_of(sum) * scale;
}

// By all rays, and with the direction.
LampBounce::Arrived LampBounce::gather(std::size_t point) const {
  const std::uint32_t* links = links_.of(point);
  const BakePlace& here = links_.places[point];
  Arrived out;
  int rays = 0;
  for (std::size_t k = 0; k < links_.per_point; ++k) {
    const std::uint32_t sender = links_.sender(links[k]);
    rays += sender != BakeLinks::kNone;
    if (sender >= BakeLinks::kNone) continue;
    Vec3f light = colour_of(radiance_[sender]);
    if (light.y <= 0) continue;
    const Vec3f way = links_.places[sender].position - here.position;
    const float away = std::max(norm(way), 1e-4f);
    if (extinction_ > 0) light *= quick::exp(-extinction_ * away);
    out.colour += light;
    const Vec3f w = way * (1 / away);
    out.vector += w * (luminance(light) / std::max(dot(w, here.normal), 0.35f));
  }
  const float scale = rays > 0 ? portable::kPiF / float(rays) : 0;
  out.colour *= scale;
  out.vector = out.vector * scale + here.normal * (luminance(out.colour) - dot(out.vector, here.normal) * scale);
  return out;
}

// The share of light that was thrown back once which comes back again: the mean over all light, in order,
// so that the number of threads does not matter.
float LampBounce::share_again() const {
  struct Sums {
    double before = 0, after = 0;
  };
  std::vector<Sums> of_pieces(seen_.size());
  pool_.run(int(seen_.size()), 16, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      Sums& sums = of_pieces[std::size_t(k)];
      const std::size_t first = first_point_[seen_[std::size_t(k)]], count = count_points(seen_[std::size_t(k)]);
      for (std::size_t i = first; i < first + count; ++i) {
        sums.before += double(luminance(colour_of(radiance_[i])));
        sums.after += double(luminance(multiply(links_.albedos[i], once_[i])));
      }
    }
  });
  double before = 0, after = 0;
  for (const Sums& sums : of_pieces) before += sums.before, after += sums.after;
  after /= portable::kPi;
  return before > 0 ? std::min(float(after / before), kMostAgain) : 0;
}

void LampBounce::pass_on() {
  const auto kept = [&](std::size_t i) { return LampReach::kept_at(distance(links_.places[i].position, reach_->lamp().position)); };
  mark_lit();
  for_seen([&](std::size_t i) { once_[i] = kept(i) > 0 ? gather_colour(i) : Vec3f(); });
  const float scale = 1 / (portable::kPiF * (1 - share_again()));
  for_seen([&](std::size_t i) {
    const Vec3f more = multiply(links_.albedos[i], once_[i]) * scale;
    radiance_[i].c += AirTransfer::Four{more.x, more.y, more.z, 0};
  });
  pool_.run(int(shown_points_.size()), 256, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::size_t i = shown_points_[std::size_t(k)];
      const float share = kept(i);
      arrived_[i] = share > 0 ? gather(i) : Arrived();
      arrived_[i].colour *= share, arrived_[i].vector *= share;
    }
  });
}

void LampBounce::add_to_node(const ShownNode& shown, const LightTable& base, const FogLight* fog) {
  const PlacedMesh& placed = scene_.placed[shown.placed];
  const LightNode& node = scene_.meshes[placed.mesh].light_nodes[shown.node];
  Vec3f colour, vector;
  for (std::size_t k = 0; k < 4; ++k) {
    const Arrived& a = arrived_[first_point_[shown.placed] + node.points[k]];
    colour += a.colour * node.weights[k], vector += a.vector * node.weights[k];
  }
  const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(node.normal)));
  if (fog) {
    const Vec3f more = fog->lamp_illuminance(Vec3f(placed.world_from_mesh * (Vec3(node.position) * placed.scale)), n);
    colour += more, vector += n * luminance(more);
  }
  if (colour.y <= 0) return;
  const std::size_t at = placed.first_light + shown.node;
  const UnpackedLight there = unpack_light(base[at], n);
  out_[at] = pack_light(there.vector + vector, there.colour + colour);
}

// Most of the light is as it was for the picture before: only what that showed is taken back.
void LampBounce::restore(const LightTable& base, std::uint64_t version) {
  if (version != version_) copy_changed(base, out_);
  version_ = version;
  for (const ShownNode& n : shown_nodes_) {
    const std::size_t at = scene_.placed[n.placed].first_light + n.node;
    out_[at] = base[at];
  }
}

void LampBounce::change_base(const LightTable& base, std::uint64_t version,
                             const std::vector<LightRange>& ranges) {
  if (version != version_) return;  // add_to() will take all of it
  for (const LightRange& range : ranges)
    std::copy(base.begin() + std::ptrdiff_t(range.begin), base.begin() + std::ptrdiff_t(range.end),
              out_.begin() + std::ptrdiff_t(range.begin));
}

void LampBounce::set_lamp(const LampReach& reach) {
  reach_ = &reach, extinction_ = reach.extinction();
  light_points();
}

// What arrives at a point is a mean of what points send, and they send what they got from the lamp, and again.
float LampBounce::most_radiance() const {
  float most = 0;
  for (const std::uint32_t piece : seen_) {
    const std::size_t first = first_point_[piece];
    for (std::size_t i = first; i < first + count_points(piece); ++i)
      most = std::max({most, radiance_[i].c[0], radiance_[i].c[1], radiance_[i].c[2]});
  }
  return most / (1 - kMostAgain);
}

const LightTable& LampBounce::add_to(const LightTable& base, std::uint64_t version,
                                                  const std::vector<Shown>& shown, FogLight* fog) {
  changed_.clear();
  if (version == version_) add_shown_to_changed();
  restore(base, version);
  find_shown(shown);
  add_shown_to_changed();
  pass_on();
  if (fog) fog->set_lamp(*reach_, radiance_);
  pool_.run(int(shown_nodes_.size()), 256, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) add_to_node(shown_nodes_[std::size_t(k)], base, fog);
  });
  return out_;
}

}  // namespace rubble
