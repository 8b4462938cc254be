// What stands in for a component of live publishing where its packages are not installed. Compiled in
// every build, so that it is known to compile in the others.
#include <gtest/gtest.h>

#include <string>

#include "io/live/live_ros.h"
#include "kernel/base/error.h"

namespace rubble {
namespace stand_in_test {

TEST(LiveStandIn, NamesThePackageThatRos1Needs) {
  EXPECT_NE(describe_ros1().find("libroscpp-dev"), std::string::npos);
  try {
    check_ros1({});
    FAIL() << "it went on";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("--ros1"), std::string::npos) << text;
    EXPECT_NE(text.find("libroscpp-dev"), std::string::npos) << text;
  }
  EXPECT_THROW(make_ros1_stream({}), InputError);
  EXPECT_THROW(make_ros1_drive({}), InputError);
}

TEST(LiveStandIn, NamesThePackageThatRos2Needs) {
  EXPECT_NE(describe_ros2().find("cyclonedds-dev"), std::string::npos);
  try {
    check_ros2({});
    FAIL() << "it went on";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("--ros2"), std::string::npos) << text;
    EXPECT_NE(text.find("cyclonedds-dev"), std::string::npos) << text;
  }
  EXPECT_THROW(make_ros2_stream({}), InputError);
  EXPECT_THROW(make_ros2_drive({}), InputError);
  EXPECT_THROW(make_ros2_server({}), InputError);
}

}  // namespace stand_in_test
}  // namespace rubble
