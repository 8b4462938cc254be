#include "io/mrpt/mrpt_types.h"

#include <stdexcept>

namespace rubble {

std::size_t MemoryStream::Read(void*, std::size_t) { throw std::logic_error("write-only"); }

std::uint64_t MemoryStream::Seek(std::int64_t, CStream::TSeekOrigin) {
  throw std::logic_error("write-only");
}

mrpt::Clock::time_point mrpt_time(std::int64_t stamp_ns) {
  constexpr std::int64_t kTicksTo1970 = 116444736000000000;  // 100 ns each, from 1601
  return mrpt::Clock::time_point(mrpt::Clock::duration(stamp_ns / 100 + kTicksTo1970));
}

mrpt::poses::CPose3D mrpt_pose(const Pose& pose) {
  const Quat& q = pose.rotation;
  const Vec3& t = pose.translation;
  // The matrix is found here: MRPT goes by angles, whose sines and cosines depend on the C library and the processor.
  mrpt::math::CMatrixDouble33 rotation;
  mrpt::math::CQuaternionDouble(q.w, q.x, q.y, q.z).rotationMatrixNoResize(rotation);
  mrpt::math::CVectorFixedDouble<3> translation;
  translation[0] = t.x, translation[1] = t.y, translation[2] = t.z;
  return {rotation, translation};
}

mrpt::img::TCamera mrpt_camera(const Intrinsics& k) {
  mrpt::img::TCamera camera;
  camera.ncols = static_cast<std::uint32_t>(k.width);
  camera.nrows = static_cast<std::uint32_t>(k.height);
  camera.setIntrinsicParamsFromValues(k.fx, k.fy, k.cx, k.cy);
  const auto& d = k.distortion;
  if (k.lens == LensModel::fisheye) {
    camera.setDistortionKannalaBrandt(d[0], d[1], d[2], d[3]);
  } else {
    camera.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
  }
  camera.cameraName = "camera";
  return camera;
}

}  // namespace rubble
