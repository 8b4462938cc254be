// Scans of LiDARs in the messages of their makers' drivers, byte by byte.
#include <gtest/gtest.h>

#include <cstring>

#include "io/ros/ros_idl.h"
#include "io/ros/ros_messages.h"

namespace rubble::ros {
namespace lidar_messages_test {

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  EXPECT_LE(offset + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

const Header kHeader{7, 1'500'000'000, "top"};
const std::vector<ScanPoint> kPoints{{3, 4, 0, 250.4f, 0, 1, 0}, {0, 0, -2, 300, 0.05f, 200, 9}};

// The last so many bytes are the points', and a flag behind them.
std::string points_of(const std::string& message, std::size_t size) { return message.substr(message.size() - 1 - size, size); }

TEST(LidarMessages, OfOusterHaveItsFields) {
  const std::string message = ouster_cloud(Version::ros2, kHeader, kPoints);
  for (const char* field : {"t", "reflectivity", "ring", "ambient", "range"})
    EXPECT_NE(message.find(std::string(field) + '\0'), std::string::npos) << field;
  const std::string points = points_of(message, 96);
  EXPECT_EQ(at<float>(points, 4), 4);
  EXPECT_EQ(at<float>(points, 16), 250.4f);
  EXPECT_EQ(at<std::uint32_t>(points, 48 + 20), 50'000'001u) << "0.05 as a float, in ns";
  EXPECT_EQ(at<std::uint16_t>(points, 24), 250);
  EXPECT_EQ(at<std::uint8_t>(points, 48 + 26), 200);
  EXPECT_EQ(at<std::uint32_t>(points, 32), 5000u);
  EXPECT_EQ(at<std::uint32_t>(points, 48 + 32), 2000u);
}

TEST(LidarMessages, OfLivoxAreItsOwn) {
  const std::string message = livox_scan(Version::ros1, kHeader, kPoints);
  const std::size_t header = 4 + 8 + 4 + 3;  // sequence, stamp, "top"
  ASSERT_EQ(message.size(), header + 8 + 4 + 4 + 4 + 2 * 19);
  EXPECT_EQ(at<std::uint64_t>(message, header), 1'500'000'000u);
  EXPECT_EQ(at<std::uint32_t>(message, header + 8), 2u);
  const std::string second = message.substr(message.size() - 19);
  EXPECT_EQ(at<std::uint32_t>(second, 0), 50'000'001u);
  EXPECT_EQ(at<float>(second, 12), -2);
  EXPECT_EQ(at<std::uint8_t>(second, 16), 255) << "as much as it can hold";
  EXPECT_EQ(at<std::uint8_t>(second, 18), 200);
  // In CDR each point is a whole number of words.
  EXPECT_EQ(livox_scan(Version::ros2, kHeader, kPoints).size(), 4u + 8 + 4 + 4 + 8 + 4 + 4 + 4 + 20 + 19);
}

TEST(Idl, HasEveryTypeAfterThoseThatItUses) {
  const std::string idl = make_idl();
  const auto place = [&](const std::string& text) {
    const std::size_t found = idl.find(text);
    EXPECT_NE(found, std::string::npos) << text;
    return found;
  };
  EXPECT_LT(place("module builtin_interfaces { module msg { module dds_ {\n  @final struct Time_ {"), place("struct Header_ {"));
  EXPECT_LT(place("struct Header_ {"), place("struct PointCloud2_ {"));
  place("    sequence<sensor_msgs::msg::dds_::PointField_> fields;\n");
  place("    double orientation_covariance[9];\n");
  place("  @final struct StepSimulation_Request_ {\n    unsigned long long client_number_;\n    long long request_number_;\n"
        "    unsigned long long steps;\n  };\n");
  EXPECT_EQ(idl.find("struct Header_ {", place("struct Header_ {") + 1), std::string::npos) << "once";
}

}  // namespace lidar_messages_test
}  // namespace rubble::ros
