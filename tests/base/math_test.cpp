// The portable functions against libm, and transforms against identities.
#include "kernel/base/math.h"

#include <gtest/gtest.h>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace math_test {

// |is - should|, in units of the value's size, but no less than those of `least`.
double error_of(double is, double should, double least) { return std::fabs(is - should) / std::max(std::fabs(should), least); }

TEST(QuickMath, IsThatOfLibm) {
  for (int i = -20000; i <= 20000; ++i) {
    const double x = 0.0137 * i, size = std::exp(0.03 * x);
    ASSERT_LT(error_of(quick::exp(2.5 * x), std::exp(2.5 * x), 0), 1e-15) << x;
    ASSERT_LT(error_of(quick::exp2(3.7 * x), std::exp2(3.7 * x), 0), 1e-15) << x;
    ASSERT_LT(error_of(quick::expm1(0.01 * x), std::expm1(0.01 * x), 1e-9), 1e-15) << x;
    ASSERT_LT(error_of(quick::log(size), std::log(size), 1), 1e-15) << size;
    ASSERT_LT(error_of(quick::log2(size), std::log2(size), 1), 1e-15) << size;
    ASSERT_LT(error_of(quick::log1p(size - 0.999), std::log1p(size - 0.999), 1), 1e-15) << size;
    ASSERT_LT(error_of(quick::pow(size, 2.4), std::pow(size, 2.4), 0), 1e-14) << size;
    ASSERT_LT(error_of(quick::cbrt(x), std::cbrt(x), 1e-9), 2e-15) << x;
    ASSERT_LT(error_of(quick::sin(x), std::sin(x), 1), 1e-15) << x;
    ASSERT_LT(error_of(quick::cos(x), std::cos(x), 1), 1e-15) << x;
    ASSERT_LT(error_of(quick::atan2(x, 0.7), std::atan2(x, 0.7), 1), 1e-15) << x;
    ASSERT_LT(error_of(quick::acos(x / 274), std::acos(x / 274), 1), 1e-15) << x;
    ASSERT_LT(error_of(quick::erf(x / 40), std::erf(x / 40), 1), 3e-15) << x;
  }
}

TEST(QuickMath, IsExactWherePeopleRelyOnIt) {
  for (int e = -60; e <= 60; ++e) {
    EXPECT_EQ(quick::exp2(double(e)), std::ldexp(1.0, e));
    EXPECT_EQ(quick::log2(std::ldexp(1.0, e)), e);
  }
  EXPECT_EQ(quick::exp(0.0), 1);
  EXPECT_EQ(quick::exp(-1e9), 0);
  EXPECT_TRUE(std::isinf(quick::exp(1e9)) && std::isinf(quick::log(0)));
  EXPECT_TRUE(std::isnan(quick::exp(std::nan(""))));
  EXPECT_EQ(quick::atan2(0.0, 0.0), 0);
  EXPECT_EQ(quick::erf(-50.0), -1);
}

TEST(PortableMath, AgreesWithLibm) {
  for (int i = -20000; i <= 20000; ++i) {
    const double x = i * 0.00731;
    EXPECT_NEAR(portable::sin(x), std::sin(x), 2e-15) << x;
    EXPECT_NEAR(portable::cos(x), std::cos(x), 2e-15) << x;
    const double e = i * 0.0171;
    EXPECT_NEAR(portable::exp(e) / std::exp(e), 1.0, 1e-15) << e;
    const double l = std::exp(i * 0.011);
    EXPECT_NEAR(portable::log(l), std::log(l), 4e-16 * std::max(1.0, std::fabs(std::log(l)))) << l;
    const double u = i / 20000.0;
    EXPECT_NEAR(portable::acos(u), std::acos(u), 1e-15) << u;
    EXPECT_NEAR(portable::asin(u), std::asin(u), 1e-15) << u;
    EXPECT_NEAR(portable::atan2(u, 0.3), std::atan2(u, 0.3), 1e-15) << u;
    EXPECT_NEAR(portable::atan2(u, -0.3), std::atan2(u, -0.3), 1e-15) << u;
  }
}

TEST(PortableMath, ReducesLargeAngles) {
  for (const double x : {1e3, 12345.678, -99999.5, 1e6})
    EXPECT_NEAR(portable::sin(x), std::sin(x), 1e-12) << x;
}

TEST(PortableMath, RollPitchYawFollowsRep103) {
  const double quarter = portable::kPi / 2;
  // A positive pitch lowers the nose; a positive yaw turns it left; roll leaves it alone.
  EXPECT_LT(distance(portable::quat_from_rpy(0, quarter, 0).rotate({1, 0, 0}), {0, 0, -1}), 1e-15);
  EXPECT_LT(distance(portable::quat_from_rpy(0, 0, quarter).rotate({1, 0, 0}), {0, 1, 0}), 1e-15);
  EXPECT_LT(distance(portable::quat_from_rpy(0.7, 0, 0).rotate({1, 0, 0}), {1, 0, 0}), 1e-15);
}

TEST(PortableMath, RollPitchYawOfARotationTurnsAsItDoes) {
  constexpr double kUp = portable::kPi / 2;
  for (const double roll : {-3.0, -0.4, 0.0, 1.2, 3.1})
    for (const double pitch : {-kUp, -kUp + 1e-9, -kUp + 1e-6, -1.2, 0.0, 0.7, kUp - 1e-7, kUp})
      for (const double yaw : {-2.9, -0.1, 0.0, 1.9}) {
        const Quat q = portable::quat_from_rpy(roll, pitch, yaw);
        const Vec3 rpy = portable::rpy_from_quat(q);
        const Quat back = portable::quat_from_rpy(rpy.x, rpy.y, rpy.z);
        for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
          EXPECT_LT(distance(q.rotate(axis), back.rotate(axis)), 1e-7) << roll << " " << pitch << " " << yaw;
      }
  // Only the difference of roll and yaw is determined there.
  const Vec3 up = portable::rpy_from_quat(portable::quat_from_rpy(0.3, kUp, 0.5));
  EXPECT_NEAR(up.z - up.x, 0.2, 1e-12);
  EXPECT_NEAR(up.z + up.x, 0, 1e-12);
}

TEST(PortableMath, SlerpKeepsAngularSpeed) {
  const Quat a = portable::quat_from_rpy(0, 0, 0), b = portable::quat_from_rpy(0, 0, 2.0);
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const Vec3 x = portable::slerp(a, b, t).rotate({1, 0, 0});
    EXPECT_NEAR(std::atan2(x.y, x.x), 2.0 * t, 1e-14);
  }
}

TEST(Pose, ComposesAndInverts) {
  const Pose a{portable::quat_from_rpy(0.1, 0.2, 0.3), {1, 2, 3}};
  const Pose b{portable::quat_from_rpy(-0.5, 0.4, 2.0), {-3, 0.5, 1}};
  const Vec3 p{0.3, -0.7, 2.2};
  EXPECT_LT(distance((a * b) * p, a * (b * p)), 1e-14);
  EXPECT_LT(distance(a.inverse() * (a * p), p), 1e-14);
  EXPECT_LT(distance(a.rotation.matrix() * p, a.rotation.rotate(p)), 1e-14);
}

TEST(Pose, OpticalFrameLooksAlongCameraX) {
  EXPECT_LT(distance(camera_from_optical * Vec3{0, 0, 1}, {1, 0, 0}), 1e-15);   // forward
  EXPECT_LT(distance(camera_from_optical * Vec3{1, 0, 0}, {0, -1, 0}), 1e-15);  // right
  EXPECT_LT(distance(camera_from_optical * Vec3{0, 1, 0}, {0, 0, -1}), 1e-15);  // down
}

}  // namespace math_test
}  // namespace rubble
