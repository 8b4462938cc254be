// URDF files as they are read: the grammar of XML and of URDF, what is optional, what is named as left out, and what is
// refused, with file and line.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "io/base/atomic_file.h"
#include "io/base/xml_document.h"
#include "io/robot/urdf_elements.h"
#include "io/robot/urdf_reader.h"
#include "kernel/base/error.h"
#include "kernel/base/text.h"
#include "tests/io/support.h"

namespace rubble {
namespace {

using test::ScratchFolder;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

UrdfFile read(const std::string& text, const std::string& name = "a.urdf") {
  const ScratchFolder folder;
  write_text_file(folder / name, text);
  return read_urdf(folder / name);
}

// Without the folder; "none": it is read.
std::string mistake_in(const std::string& text, const std::string& name = "a.urdf") {
  try {
    read(text, name);
  } catch (const InputError& error) {
    const std::string all = error.what();
    const std::size_t at = all.find(name);
    return at == std::string::npos ? all : all.substr(at);
  }
  return "none";
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

const char* const kBox = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";

// A base and an arm on a joint; what: within <joint>; more: beside it.
std::string arm(const std::string& what, const std::string& more = "") {
  return "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"arm\"/>\n<joint name=\"j\" type=\"revolute\">"
         "<parent link=\"base\"/><child link=\"arm\"/>\n" + what + "</joint>\n" + more + "</robot>\n";
}
const char* const kLimit = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>\n";

TEST(UrdfReader, ElementsThatNameJointsAndLinksElsewhereAreLeftOutWithTheirLines) {
  const UrdfFile file = read(arm(kLimit, R"(<transmission name="t"><joint name="j"/><actuator name="m"/></transmission>
<transmission name="u"><joint name="j"/></transmission>
<ros2_control name="c" type="system"><joint name="j"/><joint name="j"/></ros2_control>
<gazebo reference="arm"><sensor name="s"/><link name="arm"/></gazebo>
<!-- <link name="arm"/> -- and more -->
<!-- <joint name="j"/> -->
<future thing="1"/>
)"));
  EXPECT_EQ(file.links.size(), 2U);
  EXPECT_EQ(file.joints.size(), 1U);
  const std::string warnings = all_of(file.warnings);
  EXPECT_TRUE(holds(warnings, "a.urdf:7: <transmission> is left out (lines 7, 8): motors act on joints")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:9: <ros2_control> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:10: <gazebo> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:13: <future> is left out: not an element that this reader knows")) << warnings;
  EXPECT_EQ(file.warnings.size(), 4U) << warnings;
}

TEST(UrdfReader, UnknownAttributesAndInnerElementsAreNamed) {
  const std::string warnings = all_of(read(arm("<limit lower=\"0\" upper=\"1\" effort=\"5\" velocity=\"2\" jerk=\"3\"/>\n"
                                               "<safety_controller k_velocity=\"1\"/><calibration rising=\"0\"/>\n"
                                               "<dynamics damping=\"1\"><spring/></dynamics>")).warnings);
  EXPECT_TRUE(holds(warnings, "a.urdf:5: the attribute `jerk` of <limit> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:6: <safety_controller> in <joint> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:6: <calibration> in <joint> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:7: <spring> in <dynamics> is left out")) << warnings;
  EXPECT_TRUE(read(arm(kLimit)).warnings.empty()) << "what is known is not named";
}

// As other readers do it: the first of its kind counts. Visuals and collisions may be many.
TEST(UrdfReader, WhatStandsTwiceIsNamed) {
  const UrdfFile file = read("<robot name=\"r\"><link name=\"a\">\n<inertial><mass value=\"1\"/><mass value=\"2\"/></inertial>\n"
                             "<inertial><mass value=\"3\"/></inertial>\n" + std::string(kBox) + kBox +
                             "<visual><geometry><sphere radius=\"1\"/></geometry>\n<material name=\"m\">"
                             "<color rgba=\"255 0 0 1\"/></material></visual></link></robot>");
  EXPECT_EQ(file.links.at(0).mass, 1);
  EXPECT_EQ(file.links.at(0).collisions.size(), 2U);
  const std::string warnings = all_of(file.warnings);
  EXPECT_TRUE(holds(warnings, "a.urdf:2: a second <mass> in <inertial> is left out: the first counts")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:3: a second <inertial> in <link> is left out: the first counts")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:5: `rgba` is to be four numbers from 0 to 1, and is \"255 0 0 1\"")) << warnings;
  EXPECT_EQ(file.warnings.size(), 3U) << warnings;
}

TEST(UrdfReader, WhatIsOptionalHasItsDefault) {
  const std::string text = "<robot name=\"r\"><link name=\"base\"/><link name=\"arm\"/>"
                           "<joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/></joint></robot>";
  const UrdfFile file = read(text);
  const UrdfJoint& joint = file.joints.at(0);
  EXPECT_EQ(joint.axis.x, 1) << "the axis is X";
  EXPECT_EQ(joint.lower, -kNever);
  EXPECT_EQ(joint.upper, kNever);
  EXPECT_EQ(joint.effort, 0);
  EXPECT_EQ(joint.parent_from_child.translation.x, 0);
  EXPECT_FALSE(file.links[0].has_inertial);
  EXPECT_TRUE(file.warnings.empty()) << all_of(file.warnings);
}

TEST(UrdfReader, RangesNeedNotHoldZero) {
  const UrdfJoint joint = read(arm("<limit lower=\"-2.6\" upper=\"-0.8\" effort=\"20\" velocity=\"15\"/>")).joints.at(0);
  EXPECT_EQ(joint.lower, -2.6);
  EXPECT_EQ(joint.upper, -0.8);
  EXPECT_TRUE(holds(mistake_in(arm("<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>")), "a.urdf:5: j: its range is empty"));
  EXPECT_TRUE(holds(mistake_in(arm("")), "a.urdf:4: j: it has no <limit>"));
  const UrdfFile below = read(arm("<limit lower=\"-1\" upper=\"1\" effort=\"-1\" velocity=\"inf\"/>"));
  EXPECT_EQ(below.joints[0].effort, 0);
  EXPECT_EQ(below.joints[0].speed, 1e9);
  EXPECT_TRUE(holds(all_of(below.warnings), "a.urdf:5: `effort` of <limit> is below 0")) << all_of(below.warnings);
}

// What is larger has wrong units, and takes all memory of what lays it out.
TEST(UrdfReader, PlacesAndSizesHaveALimit) {
  const auto link = [](const std::string& inside) { return "<robot name=\"r\"><link name=\"a\">" + inside + "</link></robot>"; };
  const auto shape = [&](const std::string& inner) { return mistake_in(link("<collision><geometry>" + inner + "</geometry></collision>")); };
  for (const char* far : {"1e300 0 0", "0 -10001 0", "0 0 1e20"})
    EXPECT_TRUE(holds(mistake_in(link("<visual><origin xyz=\"" + std::string(far) + "\"/><geometry><box size=\"1 1 1\"/></geometry></visual>")),
                      "expected numbers from -10000 to 10000"))
        << far;
  EXPECT_TRUE(holds(shape("<box size=\"1e20 1 1\"/>"), "expected numbers from -10000 to 10000"));
  EXPECT_TRUE(holds(shape("<sphere radius=\"1e20\"/>"), "its geometry is too large"));
  EXPECT_TRUE(holds(shape("<cylinder radius=\"1\" length=\"20000\"/>"), "its geometry is too large"));
  EXPECT_TRUE(holds(mistake_in(link("<inertial><mass value=\"1e30\"/></inertial>")), "a mass that no robot has"));
  EXPECT_TRUE(holds(mistake_in(arm("<limit lower=\"1e8\" upper=\"1e9\" effort=\"1\" velocity=\"1\"/>")), "its range is out of reach"));
}

TEST(UrdfReader, NumbersAreReadInEveryFormAndRefusedWithTheirAttribute) {
  const auto axis = [](const std::string& xyz) { return arm(std::string(kLimit) + "<axis xyz=\"" + xyz + "\"/>"); };
  for (const char* good : {"0 1 0", "+0 1e0 .0", "\t0\n 1.0  -0 ", "0 1. 0"})
    EXPECT_EQ(read(axis(good)).joints[0].axis.y, 1) << good;
  for (const char* bad : {"0 1", "0 1 0 0", "0,5 1 0", "0 x 0", "nan 1 0", "0 1 inf", "", "0x1 1 0", "+-1 0 0"})
    EXPECT_TRUE(holds(mistake_in(axis(bad)), "a.urdf:6: j: `xyz` of <axis> cannot be read: expected three numbers")) << bad;
  EXPECT_TRUE(holds(mistake_in(axis("0 ${side} 0")), "of xacro"));
  const UrdfFile commas = read(axis("0, 1, 0"));
  EXPECT_EQ(commas.joints[0].axis.y, 1);
  EXPECT_TRUE(holds(all_of(commas.warnings), "a.urdf:6: `xyz` of <axis> has commas")) << all_of(commas.warnings);
}

TEST(UrdfReader, TreesThatAreNoneAreRefusedWithTheLineOfTheJoint) {
  const auto joint = [](const char* name, const char* parent, const char* child) {
    return std::string("<joint name=\"") + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/></joint>\n";
  };
  const std::string links = "<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/>\n";
  EXPECT_TRUE(holds(mistake_in(links + "</robot>"), "a.urdf:2: b: hangs on nothing that leads to the root"));
  EXPECT_TRUE(holds(mistake_in(links + joint("j", "a", "c") + "</robot>"), "a.urdf:3: j: the file has no link of this name"));
  EXPECT_TRUE(holds(mistake_in(links + joint("j", "a", "b") + joint("k", "a", "b") + "</robot>"), "a.urdf:4: k: closes a loop"));
  EXPECT_TRUE(holds(mistake_in(links + joint("j", "a", "b") + joint("k", "b", "a") + "</robot>"), "no root"));
  EXPECT_TRUE(holds(mistake_in(links + joint("j", "a", "b") + "<link name=\"b\"/></robot>"), "a.urdf:4: b: two links have this name"));
  EXPECT_TRUE(holds(mistake_in("<robot name=\"r\"/>"), "the robot has no link"));
  EXPECT_TRUE(holds(mistake_in(links + "<link/></robot>"), "a.urdf:3: <link> has no name"));
  const std::string loop = links + "<link name=\"c\"/>" + joint("j", "b", "c") + joint("k", "c", "b") + "</robot>";
  EXPECT_TRUE(holds(mistake_in(loop), "loop")) << mistake_in(loop);
}

TEST(UrdfReader, SiblingsComeInTheOrderOfTheirJointsNames) {
  const UrdfFile file = read("<robot name=\"r\"><link name=\"z\"/><link name=\"a\"/><link name=\"b\"/>"
                             "<joint name=\"2\" type=\"fixed\"><parent link=\"z\"/><child link=\"a\"/></joint>"
                             "<joint name=\"1\" type=\"fixed\"><parent link=\"z\"/><child link=\"b\"/></joint></robot>");
  EXPECT_EQ(file.links[1].name, "b");
  EXPECT_EQ(file.joints[1].name, "2");
  EXPECT_EQ(file.joints[1].child, 2);
}

TEST(UrdfReader, JointsOfTheWorldFixTheRobotOrLetItGo) {
  const auto on_world = [](const char* type) {
    return std::string("<robot name=\"r\"><link name=\"world\"/><link name=\"base\"/><joint name=\"j\" type=\"") + type +
           "\"><parent link=\"world\"/><child link=\"base\"/></joint></robot>";
  };
  EXPECT_TRUE(read(on_world("fixed")).fixed);
  EXPECT_EQ(read(on_world("fixed")).links.size(), 2U);
  const UrdfFile free = read(on_world("floating"));
  EXPECT_FALSE(free.fixed);
  ASSERT_EQ(free.links.size(), 1U);
  EXPECT_EQ(free.links[0].name, "base");
  EXPECT_TRUE(holds(all_of(free.warnings), "the floating joint `j`"));
  EXPECT_TRUE(holds(mistake_in(on_world("planar")), "this type of joint is not supported"));
  EXPECT_TRUE(holds(mistake_in(on_world("")), "this type of joint is not supported"));
}

TEST(UrdfReader, TextOfEveryEncodingBecomesUtf8) {
  const std::string body = "\"><link name=\"L\xf6we\"/></robot>";
  const auto name_of = [&](const std::string& head) {
    const UrdfFile file = read(head + "<robot name=\"R\xe4upe" + body);
    EXPECT_EQ(find_invalid_utf8(file.links[0].name), std::string::npos);
    EXPECT_EQ(file.links[0].name, "L\xc3\xb6we");
    return file.name;
  };
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n"), "R\xc3\xa4upe");
  EXPECT_EQ(name_of("<?xml version='1.0' encoding='windows-1252'?>"), "R\xc3\xa4upe");
  EXPECT_EQ(name_of("<?xml version='1.0' encoding='latin1'?>"), "R\xc3\xa4upe");
  // What says that it is UTF-8, and is not.
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"), "R\xc3\xa4upe");
  EXPECT_EQ(name_of(""), "R\xc3\xa4upe");
  EXPECT_TRUE(holds(all_of(read("\n<robot name=\"R\xe4" + body).warnings), "a.urdf:2: not UTF-8"));
  EXPECT_EQ(read("\xef\xbb\xbf<robot name=\"\xe2\x82\xac\"><link name=\"a\"/></robot>").name, "\xe2\x82\xac");
  EXPECT_TRUE(holds(mistake_in("<?xml version='1.0' encoding='klingon'?><robot/>"), "a.urdf:1: not well-formed XML"));
}

TEST(UrdfReader, WhatIsNoXmlOrNoUrdfIsRefusedWithItsLine) {
  EXPECT_TRUE(holds(mistake_in("<robot name=\"x\">\n<link"), "a.urdf:2: not well-formed XML"));
  EXPECT_TRUE(holds(mistake_in(""), "not well-formed XML"));
  EXPECT_TRUE(holds(mistake_in("<robot name=\"x\"><link name=\"a\"/></robot>\n<robot/>"), "a.urdf:2: not well-formed XML"));
  EXPECT_TRUE(holds(mistake_in("<sdf version=\"1.6\"/>"), "a.urdf:1: is no URDF: expected a <robot>, found <sdf>"));
  std::string deep = "<robot name=\"x\">";
  for (int i = 0; i < 100000; ++i) deep += "<link>";
  EXPECT_TRUE(holds(mistake_in(deep), "nested too deeply"));
  EXPECT_TRUE(holds(mistake_in("<!DOCTYPE r [<!ENTITY e SYSTEM \"/etc/passwd\">]><robot name=\"x\"><link name=\"a\"/>&e;</robot>"),
                    "an entity outside of the file is not read"));
  // Blanks before the declaration, and lines counted with them.
  EXPECT_EQ(read("\n\n<?xml version=\"1.0\"?><robot name=\"x\"><link name=\"a\"/></robot>").links[0].line, 3);
  EXPECT_EQ(read(std::string("<robot name=\"x\"><link name=\"a\"/></robot>\n\0", 42)).links.size(), 1U) << "a zero byte at its end";
  // A section of characters is no comment, whatever is in it.
  EXPECT_EQ(read("<robot name=\"x\"><gazebo><![CDATA[<!-- ]]></gazebo><link name=\"a\"/></robot>").links.size(), 1U);
}

TEST(UrdfReader, MaterialsAreFoundWhereverTheyAreDefined) {
  const auto visual = [](const char* material) {
    return std::string("<visual><geometry><sphere radius=\"1\"/></geometry>") + material + "</visual>\n";
  };
  const UrdfFile file = read("<robot name=\"r\">\n<link name=\"a\">\n" + visual("<material name=\"late\"/>") +
                             visual("<material name=\"inner\"/>") +
                             visual("<material name=\"inner\"><color rgba=\"0 0 1 1\"/></material>") +
                             visual("<material name=\"none\"/>") + visual("") +
                             visual("<material name=\"\"><color rgba=\"1 0 0\"/></material>") +
                             visual("<material name=\"t\"><texture filename=\"t.png\"/></material>") +
                             "</link>\n<material name=\"late\"><color rgba=\"0 1 0 0.5\"/></material></robot>");
  const std::vector<UrdfGeometry>& v = file.links[0].visuals;
  ASSERT_EQ(v.size(), 7U);
  EXPECT_EQ(v[0].colour.value().y, 1);
  EXPECT_EQ(v[1].colour.value().z, 1);
  EXPECT_EQ(v[2].colour.value().z, 1);
  for (const int plain : {3, 4, 5, 6}) EXPECT_FALSE(v[std::size_t(plain)].colour.has_value()) << plain;
  const std::string warnings = all_of(file.warnings);
  EXPECT_TRUE(holds(warnings, "a.urdf:6: the material `none` is defined nowhere")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:8: <color> is left out: `rgba` is to be four numbers")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:9: <texture> in <material> is left out")) << warnings;
  EXPECT_TRUE(holds(warnings, "a.urdf:11: the transparency of <color> is left out")) << warnings;
  EXPECT_EQ(file.warnings.size(), 4U) << warnings;
}

TEST(UrdfReader, ShapesThatAreNoneAreRefusedWithTheirLine) {
  const auto with = [](const std::string& shape) {
    return "<robot name=\"r\">\n<link name=\"a\"><collision>\n<geometry>" + shape + "</geometry></collision></link></robot>";
  };
  EXPECT_TRUE(holds(mistake_in(with("")), "a.urdf:3: a: <collision> has no shape"));
  const UrdfFile two = read(with("<sphere radius=\"1\"/><sphere radius=\"2\"/>"));
  EXPECT_EQ(two.links[0].collisions[0].radius, 1);
  EXPECT_TRUE(holds(all_of(two.warnings), "a.urdf:3: a <geometry> is one shape")) << all_of(two.warnings);
  const UrdfFile none = read(with("<sphere radius=\"0\"/>"));
  EXPECT_TRUE(none.links[0].collisions.empty());
  EXPECT_TRUE(holds(all_of(none.warnings), "a.urdf:3: <sphere> of collision has a size of 0 and is left out"));
  EXPECT_TRUE(holds(mistake_in(with("<cone radius=\"1\"/>")), "a.urdf:3: a: <cone> is not a shape that can be read"));
  EXPECT_TRUE(holds(mistake_in(with("<sphere radius=\"-1\"/>")), "a.urdf:3: a: its geometry has a size below 0"));
  EXPECT_TRUE(holds(mistake_in(with("<cylinder radius=\"1\"/>")), "a.urdf:3: a: <cylinder> has no `length`"));
  EXPECT_TRUE(holds(mistake_in(with("<mesh filename=\"package://x/gone.stl\"/>")), "a.urdf:3: a: its mesh is missing"));
  EXPECT_TRUE(holds(mistake_in(with("<mesh filename=\"t.stl\" scale=\"1 1 1 2\"/>")), "`scale` of <mesh> cannot be read: expected three numbers"));
  EXPECT_EQ(read(with("<capsule radius=\"1\" length=\"2\"/>")).links[0].collisions[0].kind, UrdfGeometry::Kind::capsule);
  EXPECT_TRUE(holds(mistake_in("<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"-1\"/></inertial></link></robot>"),
                    "a.urdf:1: a: a mass below 0"));
}

TEST(UrdfReader, MeshesAreFoundFromTheFilesFolderUpwards) {
  const ScratchFolder folder;
  const std::string robot = folder / "ws/src/bot_description/urdf/bot.urdf";
  for (const char* dir : {"ws/src/bot_description/urdf", "ws/src/bot_description/meshes/my arm", "ws/src/other/meshes", "env/share/far/m"})
    std::filesystem::create_directories(folder / dir);
  const std::string base = folder / "ws/src/bot_description/meshes/base.stl", arm = folder / "ws/src/bot_description/meshes/my arm/a.stl",
                    other = folder / "ws/src/other/meshes/o.stl", far = folder / "env/share/far/m/f.stl";
  for (const std::string& file : {base, arm, other, far, robot}) write_text_file(file, "x");
  EXPECT_EQ(find_urdf_mesh("../meshes/base.stl", robot), base);
  EXPECT_EQ(find_urdf_mesh("package://bot_description/meshes/base.stl", robot), base);
  EXPECT_EQ(find_urdf_mesh("package://my_robot_bot_description/meshes/base.stl", robot), base) << "another name of the package";
  EXPECT_EQ(find_urdf_mesh("model://other/meshes/o.stl", robot), other);
  EXPECT_EQ(find_urdf_mesh("package://bot_description/meshes/my%20arm/a.stl", robot), arm);
  EXPECT_EQ(find_urdf_mesh("..\\meshes\\base.stl", robot), base);
  EXPECT_EQ(find_urdf_mesh("file://" + base, robot), base);
  EXPECT_EQ(find_urdf_mesh("/home/someone/ws/src/bot_description/meshes/base.stl", robot), base) << "of another machine";
  EXPECT_EQ(find_urdf_mesh("file:///C:/ws/bot_description/meshes/base.stl", robot), base);
  EXPECT_EQ(find_urdf_mesh("package://far/m/f.stl", robot), "");
  setenv("AMENT_PREFIX_PATH", ("/nowhere:" + (folder / "env")).c_str(), 1);
  EXPECT_EQ(find_urdf_mesh("package://far/m/f.stl", robot), far);
  unsetenv("AMENT_PREFIX_PATH");
  setenv("ROS_PACKAGE_PATH", (folder / "env/share").c_str(), 1);
  EXPECT_EQ(find_urdf_mesh("package://far/m/f.stl", robot), far);
  unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(find_urdf_mesh("", robot), "");
  EXPECT_EQ(find_urdf_mesh("package://", robot), "");
}

const char* const kXacro = "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"r\">\n<link name=\"a\"/>\n"
                           "<xacro:wheel prefix=\"left\"/>\n</robot>\n";

TEST(UrdfReader, XacroThatIsNotExpandedIsRefusedByItsElement) {
  EXPECT_TRUE(holds(mistake_in(kXacro), "a.urdf:3: <xacro:wheel> of xacro is not expanded")) << mistake_in(kXacro);
  const std::string other = "<robot xmlns:x=\"http://wiki.ros.org/xacro\" name=\"r\"><link name=\"a\"/>\n<gazebo><x:if/></gazebo></robot>";
  EXPECT_TRUE(holds(mistake_in(other), "a.urdf:2: <x:if> of xacro")) << mistake_in(other);
  const std::string inner = "<robot name=\"r\"><link name=\"${prefix}a\"/></robot>";
  EXPECT_TRUE(holds(mistake_in(inner), "a.urdf:1: <link> of xacro")) << mistake_in(inner);
  EXPECT_EQ(read("<robot name=\"r\"><link name=\"a\"/></robot>", "a.urdf.xacro").links.size(), 1U) << "without any it is URDF";
  EXPECT_EQ(read("<robot name=\"r\"><link name=\"a\"/><gazebo><env x=\"$(env HOME)\"/></gazebo></robot>", "a.urdf").links.size(), 1U);
}

// A tool in its place: it prints its arguments, or fails.
class XacroTool : public ::testing::Test {
 protected:
  void make_tool(const std::string& script) {
    write_text_file(folder_ / "xacro", "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder_ / "xacro", std::filesystem::perms::owner_all);
    if (path_.empty()) path_ = std::getenv("PATH");
    setenv("PATH", (folder_.path() + ":" + path_).c_str(), 1);
  }
  void TearDown() override {
    if (!path_.empty()) setenv("PATH", path_.c_str(), 1);
  }
  ScratchFolder folder_;
  std::string path_;
};

TEST_F(XacroTool, ExpandsFilesWithTheArgumentsOfTheMission) {
  make_tool("echo \"<robot name='$2'><link name='$3'/></robot>\"\n");
  write_text_file(folder_ / "a.xacro", kXacro);
  const UrdfFile file = read_urdf(folder_ / "a.xacro", {{"prefix", "left arm"}, {"n", "2"}});
  EXPECT_EQ(file.name, "prefix:=left arm");
  EXPECT_EQ(file.links[0].name, "n:=2");
}

TEST_F(XacroTool, ItsFailureIsAMistakeOfTheFile) {
  make_tool("echo 'no such package: my_robot' >&2\nexit 2\n");
  const std::string said = mistake_in(kXacro, "a.xacro");
  EXPECT_TRUE(holds(said, "a.xacro:3: <xacro:wheel> of xacro cannot be expanded: the xacro tool fails")) << said;
  EXPECT_TRUE(holds(said, "no such package: my_robot")) << said;
  make_tool("printf '<robot name=\"r\">'\n");
  EXPECT_TRUE(holds(mistake_in(kXacro, "a.xacro"), "a.xacro (expanded):1: not well-formed XML"));
}

TEST_F(XacroTool, IsNamedWhereItIsMissing) {
  path_ = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  const std::string said = mistake_in(kXacro, "a.xacro");
  EXPECT_TRUE(holds(said, "a.xacro:3: <xacro:wheel> of xacro is not expanded")) << said;
  EXPECT_TRUE(holds(said, "pip install xacro")) << said;
}

TEST(UrdfReader, LinksMayHaveAnyShapesAndNames) {
  const UrdfFile file = read("<robot name=\"r\"><link name=\"X1/base link\">" + std::string(kBox) + kBox +
                             "<inertial><mass value=\"0\"/></inertial></link></robot>");
  EXPECT_EQ(file.links[0].name, "X1/base link");
  EXPECT_EQ(file.links[0].collisions.size(), 2U);
  EXPECT_FALSE(file.links[0].has_inertial) << "zeros are what is not given";
}

}  // namespace
}  // namespace rubble
