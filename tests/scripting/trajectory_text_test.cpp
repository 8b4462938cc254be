// Recorded trajectories as text: every format that others write, and what is refused.
#include "scripting/trajectory/trajectory_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"
#include "tests/scripting/test_support.h"

namespace rubble {
namespace trajectory_text_test {

RecordedTrajectory read(const std::string& text, const std::string& columns = "") { return parse_trajectory(text, "a", columns); }
std::string refusal(const std::string& text) {
  return error_of([&] { read(text); });
}
bool notes(const RecordedTrajectory& track, const std::string& words) {
  for (const std::string& note : track.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}
bool same(const Quat& a, const Quat& b) { return norm(Vec3{(a.conjugate() * b).x, (a.conjugate() * b).y, (a.conjugate() * b).z}) < 1e-9; }

const Quat kTurn{0.5, 0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)};

std::string line_of(const std::string& stamp, const std::string& order, const char* separator) {
  std::string text = stamp;
  for (const char* p : {"1", "2", "3"}) text += std::string(separator) + p;
  for (const char c : order) {
    const double value = c == 'w' ? kTurn.w : c == 'x' ? kTurn.x : c == 'y' ? kTurn.y : kTurn.z;
    char word[32];
    std::snprintf(word, sizeof word, "%s%.15g", separator, value);
    text += word;
  }
  return text + "\n";
}

TEST(TrajectoryText, NamesOfColumnsAreHeeded) {
  const std::pair<const char*, const char*> headers[] = {
      {"t,x,y,z,qx,qy,qz,qw", "xyzw"},
      {"#timestamp [s],p_x,p_y,p_z,q_x,q_y,q_z,q_w", "xyzw"},
      {"time,tx [m],ty [m],tz [m],qw,qx,qy,qz", "wxyz"},
      {"#timestamp [s], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []", "wxyz"},
      {"header.stamp,pose.position.x,pose.position.y,pose.position.z,pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w", "xyzw"},
      {"\"Timestamp\",\"X\",\"Y\",\"Z\",\"QW\",\"QX\",\"QY\",\"QZ\"", "wxyz"}};
  for (const auto& [header, order] : headers) {
    const RecordedTrajectory track = read(std::string(header) + "\n" + line_of("1.5", order, ",") + line_of("1.6", order, ","));
    ASSERT_EQ(track.poses.size(), 2u) << header;
    EXPECT_EQ(track.poses[0].stamp, 1.5) << header;
    EXPECT_EQ(track.poses[0].world_from_body.translation, Vec3(1, 2, 3)) << header;
    EXPECT_TRUE(same(track.poses[0].world_from_body.rotation, kTurn)) << header;
    EXPECT_FALSE(track.optical) << header;
  }
}

TEST(TrajectoryText, TumIsTumWithAndWithoutItsComment) {
  const std::string row = line_of("1305031102.1758", "xyzw", " "), tabs = line_of("1305031102.1758", "xyzw", "\t");
  for (const std::string& text : {row, "# ground truth\n# timestamp tx ty tz qx qy qz qw\n" + row, "#timestamp [s] x y z qx qy qz qw\n" + row, tabs}) {
    const RecordedTrajectory track = read(text);
    EXPECT_EQ(track.format.substr(0, 3), "TUM") << text;
    EXPECT_TRUE(track.optical);
    EXPECT_EQ(track.poses[0].stamp_ns, 1305031102175800000);
    EXPECT_TRUE(same(track.poses[0].world_from_body.rotation, kTurn));
  }
  // A comment in another order is heeded, too.
  const RecordedTrajectory other = read("# t x y z qw qx qy qz\n" + line_of("1", "wxyz", " "));
  EXPECT_TRUE(same(other.poses[0].world_from_body.rotation, kTurn));
  EXPECT_FALSE(other.optical);
}

TEST(TrajectoryText, StampsHaveTheirUnit) {
  const auto first = [](const std::string& stamp, const std::string& name = "t") {
    return read(name + ",x,y,z,qx,qy,qz,qw\n" + line_of(stamp, "xyzw", ",")).poses[0].stamp_ns;
  };
  EXPECT_EQ(first("1403636579.763555584"), 1403636579763555584);
  EXPECT_EQ(first("1403636579763.5"), 1403636579763500000);
  EXPECT_EQ(first("1403636579763555"), 1403636579763555000);
  EXPECT_EQ(first("1403636579763555584"), 1403636579763555584);
  EXPECT_EQ(first("1500", "t [ns]"), 1500);
  EXPECT_EQ(first("1500", "t_ms"), 1500000000);
  EXPECT_EQ(first("1500", "time (us)"), 1500000);
  // ORB-SLAM3's programs for EuRoC write nanoseconds into TUM's columns.
  EXPECT_EQ(read(line_of("1403636579763555584.000000", "xyzw", " ")).poses[0].stamp_ns, 1403636579763555584);
  // A clock that begins at 0: integers with steps of milliseconds in ns.
  const RecordedTrajectory clock = read("t,x,y,z\n0,0,0,0\n5000000,0,0,0\n10000000,0,0,0\n");
  EXPECT_EQ(clock.poses[1].stamp, 0.005);
  EXPECT_TRUE(notes(clock, "taken as nanoseconds"));
  EXPECT_NE(refusal("t,x,y,z\n0.5,0,0,0\n50000.5,0,0,0\n").find("the unit of the stamps is not clear"), std::string::npos);
  EXPECT_TRUE(notes(read("t,x,y,z\n0,0,0,0\n33,0,0,0\n66,0,0,0\n"), "taken as seconds"));
}

// As bagpy, PlotJuggler and rosbags write stamps: whole seconds and the rest. The time of arrival stands beside them.
TEST(TrajectoryText, StampsMayBeInTwoColumns) {
  for (const char* names : {"Time,header.stamp.secs,header.stamp.nsecs,x,y,z", "header.stamp.secs,header.stamp.nsecs,Time,x,y,z",
                            "__time,/odom/header/stamp/sec,/odom/header/stamp/nanosec,x,y,z", "arrival,secs,nsecs,x,y,z"}) {
    const bool first = names[0] == 'h';
    const auto row = [&](const char* secs, const char* nsecs) {
      const std::string pair = std::string(secs) + "," + nsecs;
      return (first ? pair + ",1e9" : "1e9," + pair) + ",0,0,0\n";
    };
    const RecordedTrajectory track = read(std::string(names) + "\n" + row("1700000000", "999999999") + row("1700000001", "5"));
    ASSERT_EQ(track.poses.size(), 2U) << names;
    EXPECT_EQ(track.poses[0].stamp_ns, 1'700'000'000'999'999'999) << names;
    EXPECT_EQ(track.poses[1].stamp_ns, 1'700'000'001'000'000'005) << names;
  }
  EXPECT_NE(refusal("header.stamp.secs,x,y,z\n1,0,0,0\n2,0,0,0\n").find("is half of a stamp"), std::string::npos);
  EXPECT_NE(refusal("secs,nsecs,x,y,z\n1,1000000000,0,0,0\n").find("are no stamp"), std::string::npos);
}

TEST(TrajectoryText, UnitsOfColumnsAreHeededOrRefused) {
  const auto first = [](const std::string& names, const std::string& row) { return read(names + "\n" + row + "\n").poses[0]; };
  EXPECT_NEAR(first("t [min],x [ft],y [in],z (km)", "2,1,1,0.001").stamp, 120, 1e-12);
  EXPECT_EQ(first("t [min],x [ft],y [in],z (km)", "2,1,1,0.001").stamp_ns, 120'000'000'000);
  const Vec3 place = first("t [min],x [ft],y [in],z (km)", "2,1,1,0.001").world_from_body.translation;
  EXPECT_NEAR(place.x, 0.3048, 1e-12);
  EXPECT_NEAR(place.y, 0.0254, 1e-12);
  EXPECT_NEAR(place.z, 1, 1e-12);
  EXPECT_EQ(first("t [microsec],x,y,z", "1500000,0,0,0").stamp_ns, 1'500'000'000);
  for (const char* names : {"t,x [furlong],y,z", "t [fortnight],x,y,z"})
    EXPECT_NE(refusal(std::string(names) + "\n0,0,0,0\n").find("has an unknown unit"), std::string::npos) << names;
}

TEST(TrajectoryText, EurocWithoutNamesIsKnownByItsNanoseconds) {
  const RecordedTrajectory track = read(line_of("1403636579763555584", "wxyz", ","));
  EXPECT_EQ(track.format.substr(0, 5), "EuRoC");
  EXPECT_TRUE(same(track.poses[0].world_from_body.rotation, kTurn));
  EXPECT_NE(refusal(line_of("1700000000.1", "xyzw", ",")).find("a:1: the order of the columns is not known"), std::string::npos);
  EXPECT_NE(refusal("1700000000.1;1;2;3;0;0;0;1\n").find("found 8 numbers between semicolons with stamps in s"), std::string::npos);
  EXPECT_NE(refusal("1;2;3;4;5\n").find("found 5 values between semicolons"), std::string::npos);
  EXPECT_EQ(parse_trajectory("1.5;1;2;3;0;0;0;1\n", "a", "t,x,y,z,qx,qy,qz,qw").poses[0].world_from_body.translation, Vec3(1, 2, 3));
  EXPECT_EQ(read("1403636579763555584;1;2;3;1;0;0;0\n").format, "EuRoC (stamp,px,py,pz,qw,qx,qy,qz; stamps in ns)");
  EXPECT_TRUE(same(read(line_of("1700000000.1", "xyzw", ","), "t,x,y,z,qx,qy,qz,qw").poses[0].world_from_body.rotation, kTurn));
}

TEST(TrajectoryText, MatricesAreRotations) {
  // A turn of 120 degrees about the diagonal: X goes to Y, Y to Z, Z to X.
  const std::string rows = "0 0 1 5 1 0 0 6 0 1 0 7";
  const RecordedTrajectory kitti = read(rows + "\n" + rows + "\n");
  EXPECT_FALSE(kitti.has_stamps);
  EXPECT_EQ(kitti.poses.size(), 2u);
  EXPECT_EQ(kitti.poses[0].world_from_body.translation, Vec3(5, 6, 7));
  EXPECT_NEAR(distance(kitti.poses[0].world_from_body.rotation.rotate({1, 0, 0}), {0, 1, 0}), 0, 1e-12);
  EXPECT_EQ(read("2.5 " + rows + " 0 0 0 1\n").poses[0].stamp, 2.5);
  EXPECT_NE(refusal("1 2 3 4 5 6 7 8 9 10 11 12\n").find("a:1: not a rotation"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0 0 1 0 0 0 0 -1 0\n").find("not a rotation"), std::string::npos) << "a mirror";
}

TEST(TrajectoryText, AnglesHaveTheirUnit) {
  const auto yaw = [](const std::string& name, const std::string& value) {
    return read("t,x,y,z," + name + "\n0,0,0,0," + value + "\n").poses[0].world_from_body.rotation;
  };
  const Quat quarter{std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  EXPECT_TRUE(same(yaw("yaw_deg", "90"), quarter));
  EXPECT_TRUE(same(yaw("yaw [rad]", "1.5707963267948966"), quarter));
  EXPECT_TRUE(same(yaw("yaw", "90"), quarter)) << "more than a turn in radians";
  EXPECT_NE(refusal("t,x,y,z,yaw\n0,0,0,0,1.5\n").find("column `yaw` may be degrees or radians"), std::string::npos);
}

TEST(TrajectoryText, RepeatedStampsAreKeptAndTold) {
  const RecordedTrajectory track = read(line_of("1", "xyzw", " ") + line_of("1", "xyzw", " ") + line_of("1", "xyzw", " "));
  EXPECT_EQ(track.poses.size(), 3u);
  EXPECT_EQ(track.repeated, (std::vector<int>{2, 3}));
  EXPECT_TRUE(notes(track, "line 2 repeats the stamp of the line before, as do 1 more"));
}

TEST(TrajectoryText, WhatIsWrongIsNamed) {
  const std::pair<const char*, const char*> kBad[] = {
      {"", "a: has no pose"},
      {"# nothing\n", "has no pose"},
      {"t,y,z\n0,1,2\n", "has no column x"},
      {"x,y,z\n0,1,2\n", "has no column t"},
      {"t,x,y,z,qx,qy,qz\n0,1,2,3,0,0,0\n", "a part of a quaternion"},
      {"t,x,px,y,z\n0,1,1,2,3\n", "columns `x` and `px` mean the same"},
      {"t,x,y,z\n0,1,2\n", "a:2: not a pose: expected 4 values, as line 1 names"},
      {"t,x,y,z\n0,1,2,3\n1,1,two,3\n", "a:3: no number in the column y"},
      {"1 2 3\n", "a:1: not a pose"},
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n", "a:2: not a pose: expected 8 values as in line 1"},
      {"1 0 0 0 0 0 0 1\n2,0,0,0,0,0,0,1\n", ""},
      {"1 0 0 0 0 0 0 2\n", "a:1: not a rotation"},
      {"1 0 nan 0 0 0 0 1\n", "a:1: not finite"},
      {"2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "a:2: out of order"},
      {"0;1,5;2;3\n", "a:1: not a pose"},
      {"t;x;y;z\n0;1,5;2;3\n", "write numbers with a decimal point"},
      {"#t,x,y,z,qx,qy,qz\n0,1,2,3,0,0,0,1\n", "a:1: is a header of other columns"},
      {"\xff\xfe" "1", "is UTF-16 text"},
  };
  for (const auto& [text, message] : kBad) EXPECT_NE(refusal(text).find(message), std::string::npos) << text << "\n" << refusal(text);
}

TEST(TrajectoryText, LeftOutColumnsAreTold) {
  const RecordedTrajectory track = read("t,x,y,z,vx,temperature\n0,1,2,3,4,5\n");
  EXPECT_TRUE(notes(track, "left out: vx, temperature"));
  EXPECT_TRUE(notes(track, "no column is an orientation"));
  EXPECT_FALSE(track.has_rotations);
}

// At every pitch, the poles among them, the angles give the rotation back.
TEST(RollPitchYaw, InvertsTheRotation) {
  for (double pitch = -90; pitch <= 90; pitch += 7.5)
    for (double roll = -180; roll <= 180; roll += 40)
      for (double yaw = -180; yaw <= 180; yaw += 40) {
        const double k = portable::kPi / 180;
        const Quat q = portable::quat_from_rpy(roll * k, pitch * k, yaw * k);
        for (const Quat& one : {q, Quat{-q.w, -q.x, -q.y, -q.z}}) {
          const Vec3 rpy = portable::rpy_from_quat(one);
          EXPECT_NEAR(rpy.y, pitch * k, 1e-7);
          EXPECT_LE(std::abs(rpy.x), portable::kPi + 1e-12);
          const Quat d = q.conjugate() * portable::quat_from_rpy(rpy.x, rpy.y, rpy.z);
          EXPECT_NEAR(norm(Vec3{d.x, d.y, d.z}), 0, 1e-11) << roll << " " << pitch << " " << yaw;
        }
      }
  EXPECT_EQ(portable::rpy_from_quat(Quat{}), Vec3(0, 0, 0));
}

}  // namespace trajectory_text_test
}  // namespace rubble
