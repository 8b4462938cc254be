#include "render/geometry/embree_tree.h"

#include <algorithm>
#include <string>

#include "kernel/base/error.h"

namespace rubble {

namespace {

std::string reason_of(RTCError error) {
  if (error == RTC_ERROR_UNSUPPORTED_CPU) return "Embree does not know this processor";
  if (error == RTC_ERROR_OUT_OF_MEMORY) return "out of memory";
  return "Embree gives no device, error " + std::to_string(int(error)) + "; it says no more where a process is out of memory";
}

}  // namespace

EmbreeTree::EmbreeTree() : device(rtcNewDevice("threads=1,set_affinity=0")) {
  if (!device) throw RunError("cannot cast rays: " + reason_of(rtcGetDeviceError(nullptr)));
  scene = new_scene();
}

EmbreeTree::~EmbreeTree() {
  if (scene) rtcReleaseScene(scene);
  if (resting) rtcReleaseScene(resting);
  for (const auto& [mesh, of_mesh] : meshes) rtcReleaseScene(of_mesh);
  if (device) rtcReleaseDevice(device);
}

RTCScene EmbreeTree::new_scene() const {
  const RTCScene made = rtcNewScene(device);
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
  return made;
}

void EmbreeTree::attach(RTCScene to, const std::vector<Vec3f>& positions, const std::uint32_t* indices,
                        std::size_t triangles) const {
  if (triangles == 0) return;
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // One vertex more: Embree reads 16 bytes of the last.
  void* const vertex_memory = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                      sizeof(Vec3f), positions.size() + 1);
  void* const index_memory = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                     3 * sizeof(std::uint32_t), triangles);
  if (!vertex_memory || !index_memory)
    throw RunError("cannot cast rays: out of memory for " + std::to_string(triangles) + " triangles");
  std::copy(positions.begin(), positions.end(), static_cast<Vec3f*>(vertex_memory));
  std::copy_n(indices, 3 * triangles, static_cast<std::uint32_t*>(index_memory));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to, geometry, kResting);
  rtcReleaseGeometry(geometry);
}

RTCGeometry EmbreeTree::attach_instance(RTCScene of, unsigned number) const {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, of);
  rtcAttachGeometryByID(scene, geometry, number);
  rtcReleaseGeometry(geometry);  // the tree keeps it
  return geometry;
}

void EmbreeTree::commit() {
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw RunError("cannot cast rays: Embree reports an error while building its tree");
}

}  // namespace rubble
