// Embree 3 or 4, whichever the build has found (cmake/RubbleEmbree.cmake), and what differs between them: how a ray
// query is asked. All else of their interfaces that Rubble uses is the same.
#pragma once

#if RUBBLE_EMBREE == 4
#include <embree4/rtcore.h>
#elif RUBBLE_EMBREE == 3
#include <embree3/rtcore.h>
#else
#error "link rubble_embree, which says which version of Embree this is"
#endif

namespace rubble {

#if RUBBLE_EMBREE == 4

// What a query takes along. A class derived from it reaches the callbacks of user geometry, as args->context.
struct EmbreeRayContext : RTCRayQueryContext {
  // Coherent rays go the same way: a packet of them is answered faster when Embree knows it.
  explicit EmbreeRayContext(bool coherent = false)
      : flags(coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) {
    rtcInitRayQueryContext(this);
  }
  RTCRayQueryFlags flags;
};

// init: the function of Embree that sets the defaults of these arguments.
template <class Arguments>
Arguments embree_arguments(EmbreeRayContext& context, void (*init)(Arguments*)) {
  Arguments arguments;
  init(&arguments);
  arguments.flags = context.flags;
  arguments.context = &context;
  return arguments;
}

// The nearest hit.
inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeRayContext& context) {
  auto arguments = embree_arguments(context, rtcInitIntersectArguments);
  rtcIntersect1(scene, &ray, &arguments);
}
// valid: -1 for each ray that counts, 0 for the others; aligned to 32 bytes, as `rays`.
inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit8& rays, EmbreeRayContext& context) {
  auto arguments = embree_arguments(context, rtcInitIntersectArguments);
  rtcIntersect8(valid, scene, &rays, &arguments);
}

// Whether anything is hit: `tfar` is negative then.
inline void embree_occlude(RTCScene scene, RTCRay& ray, EmbreeRayContext& context) {
  auto arguments = embree_arguments(context, rtcInitOccludedArguments);
  rtcOccluded1(scene, &ray, &arguments);
}
inline void embree_occlude(RTCScene scene, const int* valid, RTCRay8& rays, EmbreeRayContext& context) {
  auto arguments = embree_arguments(context, rtcInitOccludedArguments);
  rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

struct EmbreeRayContext : RTCIntersectContext {
  explicit EmbreeRayContext(bool coherent = false) {
    rtcInitIntersectContext(this);
    flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};

inline void embree_intersect(RTCScene scene, RTCRayHit& ray, EmbreeRayContext& context) {
  rtcIntersect1(scene, &context, &ray);
}
inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit8& rays, EmbreeRayContext& context) {
  rtcIntersect8(valid, scene, &context, &rays);
}
inline void embree_occlude(RTCScene scene, RTCRay& ray, EmbreeRayContext& context) {
  rtcOccluded1(scene, &context, &ray);
}
inline void embree_occlude(RTCScene scene, const int* valid, RTCRay8& rays, EmbreeRayContext& context) {
  rtcOccluded8(valid, scene, &context, &rays);
}

#endif

}  // namespace rubble
