// Many rays at once: in packets of eight where they go the same way.
#include <algorithm>

#include "render/geometry/ray_scene_embree.h"

namespace rubble {

namespace {

constexpr std::size_t kWidth = 8;

struct alignas(32) Lanes {
  int valid[kWidth];
};

// Lanes beyond `count` are off.
void fill(const RayScene::Ray* rays, std::size_t count, Lanes& lanes, RTCRay8& out) {
  for (std::size_t i = 0; i < kWidth; ++i) {
    lanes.valid[i] = i < count ? -1 : 0;
    const RayScene::Ray& ray = rays[std::min(i, count - 1)];
    out.org_x[i] = ray.from.x, out.org_y[i] = ray.from.y, out.org_z[i] = ray.from.z;
    out.dir_x[i] = ray.direction.x, out.dir_y[i] = ray.direction.y, out.dir_z[i] = ray.direction.z;
    out.tnear[i] = ray.nearest, out.tfar[i] = ray.farthest, out.time[i] = 0;
    out.mask[i] = 0xffffffffu, out.id[i] = 0, out.flags[i] = 0;
  }
}

RTCRay one(const RayScene::Ray& ray) {
  return {ray.from.x,      ray.from.y,      ray.from.z, ray.nearest,  ray.direction.x,
          ray.direction.y, ray.direction.z, 0,          ray.farthest, 0xffffffffu,
          0,               0};
}

}  // namespace

void RayScene::cast_many(const Ray* rays, std::size_t count, Order order, PreciseHit* hits) const {
  EmbreeRayContext context(order == Order::coherent);
  if (order == Order::scattered) {
    for (std::size_t i = 0; i < count; ++i) {
      RTCRayHit query{};
      query.ray = one(rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree_intersect(embree_->scene, query, context);
      hits[i] = PreciseHit();
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      const Met met = met_by(query.hit.primID, query.hit.instID[0],
                             {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
      hits[i] = {met.triangle, query.ray.tfar, query.hit.u, query.hit.v,
                 dot(met.normal, rays[i].direction) > 0};
    }
    return;
  }
  for (std::size_t first = 0; first < count; first += kWidth) {
    Lanes lanes;
    RTCRayHit8 query;
    fill(rays + first, count - first, lanes, query.ray);
    for (unsigned& id : query.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
    for (unsigned& id : query.hit.instID[0]) id = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(embree_->scene, lanes.valid, query, context);
    for (std::size_t i = 0; i < std::min(kWidth, count - first); ++i) {
      hits[first + i] = PreciseHit();
      if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const Met met = met_by(query.hit.primID[i], query.hit.instID[0][i],
                             {query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]});
      hits[first + i] = {met.triangle, query.ray.tfar[i], query.hit.u[i], query.hit.v[i],
                         dot(met.normal, rays[first + i].direction) > 0};
    }
  }
}

void RayScene::blocked_many(const Ray* rays, std::size_t count, Order order,
                            std::uint8_t* hidden) const {
  EmbreeRayContext context(order == Order::coherent);
  if (order == Order::scattered) {
    for (std::size_t i = 0; i < count; ++i) {
      RTCRay ray = one(rays[i]);
      embree_occlude(embree_->scene, ray, context);
      hidden[i] = ray.tfar < 0;
    }
    return;
  }
  for (std::size_t first = 0; first < count; first += kWidth) {
    Lanes lanes;
    RTCRay8 query;
    fill(rays + first, count - first, lanes, query);
    embree_occlude(embree_->scene, lanes.valid, query, context);
    for (std::size_t i = 0; i < std::min(kWidth, count - first); ++i)
      hidden[first + i] = query.tfar[i] < 0;
  }
}

}  // namespace rubble
