#include "render/geometry/ray_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/system/embree.h"

namespace rubble {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kFarAway = 2;         // of the reach: rays from beyond begin anew where they come this near
constexpr double kPlaceMargin = 4e-6;  // of the reach: what placing a box or a ray rounds

std::string reason_of(RTCError error) {
  if (error == RTC_ERROR_UNSUPPORTED_CPU) return "Embree does not know this processor";
  if (error == RTC_ERROR_OUT_OF_MEMORY) return "out of memory";
  return "Embree gives no device, error " + std::to_string(int(error)) + "; it says no more where a process is out of memory";
}

float round_down(double x) { return std::nextafter(float(x), -kInfinity); }
float round_up(double x) { return std::nextafter(float(x), kInfinity); }

void write_bounds(const Aabb& box, RTCBounds& bounds) {
  bounds.lower_x = round_down(box.min.x), bounds.lower_y = round_down(box.min.y), bounds.lower_z = round_down(box.min.z);
  bounds.upper_x = round_up(box.max.x), bounds.upper_y = round_up(box.max.y), bounds.upper_z = round_up(box.max.z);
}

// How far a tree has to look for hits up to a distance: beyond the beginning in any case, or a hit right there could hide
// another one as near.
float tree_end(float nearest, float distance) { return std::max(distance, nearest + std::max(1e-6f * nearest, 1e-30f)); }

RTCRay ray_of(const BlockRay& ray, float farthest) {
  return {ray.from.x,      ray.from.y,      ray.from.z, ray.nearest,                      ray.direction.x,
          ray.direction.y, ray.direction.z, 0,          tree_end(ray.nearest, farthest), 0xffffffffu,
          0,               0};
}

// A mesh, and Embree's tree of its blocks.
struct Mesh {
  RTCScene scene = nullptr;
  std::vector<TriangleBlock> blocks;
  float reach = 0;  // farthest from its origin that a ray begins; unit: m
  Aabb bounds;

  Mesh() = default;
  ~Mesh() {
    if (scene) rtcReleaseScene(scene);
  }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  void meet(const BlockRay& ray, BlockHit& hit) const;
  bool hides(const BlockRay& ray, float farthest) const;
};

// A part at the last commit().
struct Placed {
  const Mesh* mesh = nullptr;  // null: not there
  std::uint32_t first_id = 0;
  bool in_world = false;  // the frame of the mesh is the world's
  bool moves = false;     // between times 0 and 1
  double scale = 1;
  Pose first, last;
  Mat3 mesh_from_world;  // turn and scale at time 0
  Aabb bounds;

  BlockRay ray_in_mesh(const BlockRay& ray, float time) const {
    Vec3 from(ray.from), direction(ray.direction);
    if (in_world) return {ray.from, ray.direction, ray.nearest, mesh->reach, first_id};
    if (moves) {
      const Pose now{portable::slerp(first.rotation, last.rotation, double(time)),
                     first.translation + (last.translation - first.translation) * double(time)};
      const Mat3 turn = now.rotation.matrix().transposed() * (1 / scale);
      return {Vec3f(turn * (from - now.translation)), Vec3f(turn * direction), ray.nearest, mesh->reach, first_id};
    }
    return {Vec3f(mesh_from_world * (from - first.translation)), Vec3f(mesh_from_world * direction), ray.nearest, mesh->reach,
            first_id};
  }
};

// What the callbacks of a query know: of each ray of a packet, or of the one.
struct BlockQuery : EmbreeRayContext {
  BlockQuery(const BlockRay* rays_, BlockHit* hits_, bool coherent) : EmbreeRayContext(coherent), rays(rays_), hits(hits_) {}
  const BlockRay* rays;
  BlockHit* hits;
};
struct PartQuery : EmbreeRayContext {
  PartQuery(const BlockRay* rays_, const float* times_, RayTree::Hit* hits_, bool coherent)
      : EmbreeRayContext(coherent), rays(rays_), times(times_), hits(hits_) {}
  const BlockRay* rays;
  const float* times;
  RayTree::Hit* hits;
};

constexpr std::size_t kPacket = RayTree::kPacket;

// Rays of a packet, and what is met until now: nothing.
struct Packet {
  Packet(const RayTree::Line* lines, std::size_t count, const Placed& part, RTCRay8& out) {
    for (std::size_t i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      const RayTree::Line& line = lines[std::min(i, count - 1)];
      rays[i] = {line.from, line.direction, line.nearest, part.mesh->reach, part.first_id};
      hits[i].distance = line.farthest;
      out.org_x[i] = line.from.x, out.org_y[i] = line.from.y, out.org_z[i] = line.from.z;
      out.dir_x[i] = line.direction.x, out.dir_y[i] = line.direction.y, out.dir_z[i] = line.direction.z;
      out.tnear[i] = line.nearest, out.tfar[i] = tree_end(line.nearest, line.farthest), out.time[i] = 0;
      out.mask[i] = 0xffffffffu, out.id[i] = unsigned(i), out.flags[i] = 0;
    }
  }
  alignas(32) int valid[kPacket];
  BlockRay rays[kPacket];
  BlockHit hits[kPacket];
};

const BlockFunctions& functions() {
  static const BlockFunctions chosen = block_functions().front();
  return chosen;
}

RTCRayN* rays_in(const RTCIntersectFunctionNArguments* args) { return RTCRayHitN_RayN(args->rayhit, args->N); }

void bound_block(const RTCBoundsFunctionArguments* args) {
  const Mesh& mesh = *static_cast<const Mesh*>(args->geometryUserPtr);
  write_bounds(tree_bounds(mesh.blocks[args->primID], mesh.reach), *args->bounds_o);
}
// A processor may lack packets of this size: Embree then calls with parts of them. The number of a ray is in `id`.
void meet_block(const RTCIntersectFunctionNArguments* args) {
  const auto& query = *static_cast<const BlockQuery*>(args->context);
  const TriangleBlock& block = static_cast<const Mesh*>(args->geometryUserPtr)->blocks[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned ray = RTCRayN_id(rays_in(args), args->N, i);
    if (functions().meet(block, query.rays[ray], query.hits[ray]))
      RTCRayN_tfar(rays_in(args), args->N, i) = tree_end(query.rays[ray].nearest, query.hits[ray].distance);
  }
}
void hide_by_block(const RTCOccludedFunctionNArguments* args) {
  const auto& query = *static_cast<const BlockQuery*>(args->context);
  const TriangleBlock& block = static_cast<const Mesh*>(args->geometryUserPtr)->blocks[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned ray = RTCRayN_id(args->ray, args->N, i);
    if (functions().hides(block, query.rays[ray], query.hits[ray].distance))
      RTCRayN_tfar(args->ray, args->N, i) = -kInfinity;
  }
}

void Mesh::meet(const BlockRay& ray, BlockHit& hit) const {
  BlockQuery query(&ray, &hit, false);
  RTCRayHit asked{};
  asked.ray = ray_of(ray, hit.distance);
  asked.hit.geomID = asked.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(scene, asked, query);
}

bool Mesh::hides(const BlockRay& ray, float farthest) const {
  BlockHit limit;
  limit.distance = farthest;
  BlockQuery query(&ray, &limit, false);
  RTCRay asked = ray_of(ray, farthest);
  embree_occlude(scene, asked, query);
  return asked.tfar < 0;
}

bool meet_placed(const Placed& part, std::uint32_t number, const BlockRay& ray, float time, RayTree::Hit& hit) {
  BlockHit found = hit;
  part.mesh->meet(part.ray_in_mesh(ray, time), found);
  if (found.triangle == hit.triangle) return false;
  static_cast<BlockHit&>(hit) = found;
  hit.part = number;
  return true;
}

void bound_part(const RTCBoundsFunctionArguments* args) {
  const Placed& part = static_cast<const Placed*>(args->geometryUserPtr)[args->primID];
  if (part.mesh) return write_bounds(part.bounds, *args->bounds_o);
  // What is empty is left out of the tree.
  RTCBounds& bounds = *args->bounds_o;
  bounds.lower_x = bounds.lower_y = bounds.lower_z = kInfinity;
  bounds.upper_x = bounds.upper_y = bounds.upper_z = -kInfinity;
}
void meet_part(const RTCIntersectFunctionNArguments* args) {
  const auto& query = *static_cast<const PartQuery*>(args->context);
  const Placed& part = static_cast<const Placed*>(args->geometryUserPtr)[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] && meet_placed(part, args->primID, query.rays[i], query.times[i], query.hits[i]))
      RTCRayN_tfar(rays_in(args), args->N, i) = tree_end(query.rays[i].nearest, query.hits[i].distance);
}
void hide_by_part(const RTCOccludedFunctionNArguments* args) {
  const auto& query = *static_cast<const PartQuery*>(args->context);
  const Placed& part = static_cast<const Placed*>(args->geometryUserPtr)[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] && part.mesh->hides(part.ray_in_mesh(query.rays[i], query.times[i]), query.hits[i].distance))
      RTCRayN_tfar(args->ray, args->N, i) = -kInfinity;
}

// Of a mesh between the two poses of a part.
Aabb bounds_of(const Placed& part, double margin) {
  Aabb box;
  double farthest = 0;  // of a corner from the origin of the mesh; unit: m
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = Vec3(i & 1 ? part.mesh->bounds.max.x : part.mesh->bounds.min.x,
                             i & 2 ? part.mesh->bounds.max.y : part.mesh->bounds.min.y,
                             i & 4 ? part.mesh->bounds.max.z : part.mesh->bounds.min.z) *
                        part.scale;
    farthest = std::max(farthest, norm(corner));
    box.include(part.first * corner), box.include(part.last * corner);
  }
  // On its way a corner leaves the line between its ends by no more than the height of the arc.
  const Quat &a = part.first.rotation, &b = part.last.rotation;
  const double half_turn = std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);  // its cosine
  const double more = margin + farthest * std::max(0.0, 1 - half_turn);
  return {box.min - Vec3(more, more, more), box.max + Vec3(more, more, more)};
}

}  // namespace

struct RayTree::Embree {
  // One thread builds: a mission has threads enough of its own.
  Embree() : device(rtcNewDevice("threads=1,set_affinity=0")) {
    if (!device) throw RunError("cannot cast rays: " + reason_of(rtcGetDeviceError(nullptr)));
  }
  ~Embree() {
    meshes.clear();
    if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  RTCScene new_scene() const {
    const RTCScene made = rtcNewScene(device);
    rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
    return made;
  }
  // elements: what the functions know them by.
  RTCGeometry attach(RTCScene to, void* elements, std::size_t count, RTCBoundsFunction bound, RTCIntersectFunctionN meet,
                     RTCOccludedFunctionN hide) const {
    const RTCGeometry made = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(made, unsigned(count));
    rtcSetGeometryUserData(made, elements);
    rtcSetGeometryBoundsFunction(made, bound, nullptr);
    rtcSetGeometryIntersectFunction(made, meet);
    rtcSetGeometryOccludedFunction(made, hide);
    rtcCommitGeometry(made);
    rtcAttachGeometryByID(to, made, 0);
    rtcReleaseGeometry(made);  // the scene keeps it
    return made;
  }
  std::uint32_t add_mesh(std::vector<TriangleBlock> blocks, double reach);
  // Of all parts, anew where their number has changed.
  void build() {
    if (parts_in_scene != placed.data() || count_in_scene != placed.size()) {
      if (scene) rtcReleaseScene(scene);
      scene = new_scene();
      geometry = attach(scene, placed.data(), placed.size(), bound_part, meet_part, hide_by_part);
      parts_in_scene = placed.data(), count_in_scene = placed.size();
    } else {
      rtcCommitGeometry(geometry);
    }
    rtcCommitScene(scene);
  }

  RTCDevice device;
  std::map<std::uint32_t, std::unique_ptr<Mesh>> meshes;
  std::uint32_t next_mesh = 0;
  std::vector<Placed> placed;
  const Placed* alone = nullptr;  // the one part that there is, in the frame of the world
  std::uint32_t alone_number = 0;
  RTCScene scene = nullptr;  // of the parts, unless one is alone
  RTCGeometry geometry = nullptr;
  const Placed* parts_in_scene = nullptr;
  std::size_t count_in_scene = 0;
};

RayTree::RayTree(double reach) : reach_(std::max(1.0, reach)), embree_(std::make_unique<Embree>()) {}
RayTree::~RayTree() = default;

std::uint32_t RayTree::Embree::add_mesh(std::vector<TriangleBlock> blocks, double reach) {
  if (blocks.empty()) return kNone;
  auto mesh = std::make_unique<Mesh>();
  mesh->blocks = std::move(blocks), mesh->reach = float(reach);
  for (const TriangleBlock& block : mesh->blocks) {
    const Aabb box = tree_bounds(block, mesh->reach);
    mesh->bounds.include(box.min), mesh->bounds.include(box.max);
  }
  mesh->scene = new_scene();
  attach(mesh->scene, mesh.get(), mesh->blocks.size(), bound_block, meet_block, hide_by_block);
  rtcCommitScene(mesh->scene);
  meshes.emplace(next_mesh, std::move(mesh));
  return next_mesh++;
}

std::uint32_t RayTree::add_mesh(std::vector<TriangleBlock> blocks) {
  return embree_->add_mesh(std::move(blocks), kFarAway * reach_);
}

std::uint32_t RayTree::add_mesh(const BlockOrder& order, const TriangleCorners& corners, double smallest_scale) {
  std::vector<TriangleBlock> blocks;
  blocks.reserve(order.ends.size());
  append_blocks(order, corners, 0, blocks);
  // A ray begins at most kFarAway from the origin, a mesh lies at most once the reach from it.
  return embree_->add_mesh(std::move(blocks), (kFarAway + 1) * reach_ / smallest_scale);
}

void RayTree::drop_mesh(std::uint32_t mesh) { embree_->meshes.erase(mesh); }

void RayTree::commit() {
  Embree& e = *embree_;
  e.placed.resize(parts_.size());
  e.alone = nullptr;
  std::size_t there = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    Placed& placed = e.placed[i] = Placed();
    if (part.mesh == kNone) continue;
    placed.mesh = e.meshes.at(part.mesh).get();
    placed.first_id = part.first_id, placed.scale = part.scale, placed.first = part.first, placed.last = part.last;
    placed.moves = !(part.first == part.last);
    placed.in_world = !placed.moves && part.scale == 1 && part.first == Pose();
    placed.mesh_from_world = part.first.rotation.matrix().transposed() * (1 / part.scale);
    placed.bounds = bounds_of(placed, kPlaceMargin * reach_);
    ++there;
    if (placed.in_world) e.alone = &placed, e.alone_number = std::uint32_t(i);
  }
  if (there != 1) e.alone = nullptr;
  if (!e.alone && there > 0) e.build();
  if (there == 0 && e.scene) rtcReleaseScene(e.scene), e.scene = nullptr, e.parts_in_scene = nullptr;
  if (rtcGetDeviceError(e.device) != RTC_ERROR_NONE)
    throw RunError("cannot cast rays: Embree reports an error while building its tree");
}

namespace {

// Where a ray from far away comes near: rounding grows with the distance. Negative: it does not, or begins there.
float find_near_start(const RayTree::Line& line, double reach) {
  const Vec3 from(line.from), direction(line.direction);
  const double c = dot(from, from) - reach * reach;
  if (c <= 0) return -1;
  const double a = dot(direction, direction), b = dot(from, direction), d = b * b - a * c;
  return d <= 0 || b >= 0 ? -1 : float((-b - std::sqrt(d)) / a);
}

}  // namespace

RayTree::Hit RayTree::meet(const Line& line) const {
  const Embree& e = *embree_;
  Hit hit;
  hit.distance = line.farthest;
  const auto cast = [&](const BlockRay& ray) {
    if (e.alone) {
      meet_placed(*e.alone, e.alone_number, ray, line.time, hit);
    } else if (e.scene) {
      PartQuery query(&ray, &line.time, &hit, false);
      RTCRayHit asked{};
      asked.ray = ray_of(ray, hit.distance);
      asked.hit.geomID = asked.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree_intersect(e.scene, asked, query);
    }
  };
  const float start = find_near_start(line, kFarAway * reach_);
  const bool in_two = start > line.nearest && start < line.farthest;
  if (in_two) hit.distance = start;
  cast({line.from, line.direction, line.nearest, 0});
  if (!in_two || hit.triangle != kNone) return hit;
  hit.distance = line.farthest - start;
  cast({line.from + line.direction * start, line.direction, 0, 0});
  hit.distance += start;
  return hit;
}

bool RayTree::hides(const Line& line) const {
  const Embree& e = *embree_;
  const auto cast = [&](const BlockRay& ray, float farthest) {
    if (e.alone) return e.alone->mesh->hides(e.alone->ray_in_mesh(ray, line.time), farthest);
    if (!e.scene) return false;
    Hit limit;
    limit.distance = farthest;
    PartQuery query(&ray, &line.time, &limit, false);
    RTCRay asked = ray_of(ray, farthest);
    embree_occlude(e.scene, asked, query);
    return asked.tfar < 0;
  };
  const float start = find_near_start(line, kFarAway * reach_);
  if (start <= line.nearest || start >= line.farthest)
    return cast({line.from, line.direction, line.nearest, 0}, line.farthest);
  return cast({line.from, line.direction, line.nearest, 0}, start) ||
         cast({line.from + line.direction * start, line.direction, 0, 0}, line.farthest - start);
}

// Packets are for what rests alone: each ray has its own place among what moves.
bool RayTree::has_packets(const Line* lines, std::size_t count) const {
  const double far = kFarAway * reach_;
  return embree_->alone && std::all_of(lines, lines + count, [far](const Line& line) {
           return dot(Vec3(line.from), Vec3(line.from)) <= far * far;
         });
}

void RayTree::meet_packet(const Line* lines, std::size_t count, Hit* hits) const {
  if (!has_packets(lines, count)) {
    for (std::size_t i = 0; i < count; ++i) hits[i] = meet(lines[i]);
    return;
  }
  const Embree& e = *embree_;
  RTCRayHit8 asked;
  Packet packet(lines, count, *e.alone, asked.ray);
  for (std::size_t i = 0; i < kPacket; ++i) asked.hit.geomID[i] = asked.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  BlockQuery query(packet.rays, packet.hits, true);
  embree_intersect(e.alone->mesh->scene, packet.valid, asked, query);
  for (std::size_t i = 0; i < count; ++i) {
    static_cast<BlockHit&>(hits[i]) = packet.hits[i];
    hits[i].part = packet.hits[i].triangle == kNone ? kNone : e.alone_number;
  }
}

void RayTree::hide_packet(const Line* lines, std::size_t count, std::uint8_t* hidden) const {
  if (!has_packets(lines, count)) {
    for (std::size_t i = 0; i < count; ++i) hidden[i] = hides(lines[i]);
    return;
  }
  const Embree& e = *embree_;
  RTCRay8 asked;
  Packet packet(lines, count, *e.alone, asked);
  BlockQuery query(packet.rays, packet.hits, true);
  embree_occlude(e.alone->mesh->scene, packet.valid, asked, query);
  for (std::size_t i = 0; i < count; ++i) hidden[i] = asked.tfar[i] < 0;
}

}  // namespace rubble
