// The elements and attributes of a URDF file: numbers, vectors and poses with their defaults, and a record of
// what is wrong, what is left out and what was doubtful, each with file, line and element.
//
// A reader says of every element which attributes and children it knows (expect()). What it does not know is
// named as left out: nothing of a file disappears without a word.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/base/xml_document.h"
#include "io/robot/urdf_reader.h"
#include "kernel/base/error.h"
#include "kernel/base/math.h"

namespace rubble {

class UrdfElements {
 public:
  // path: of the file, for messages.
  explicit UrdfElements(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  // The link or joint that is read: the key of messages.
  void set_owner(std::string name) { owner_ = std::move(name); }

  void mistake(int line, const std::string& message, const std::string& expected, const std::string& found,
               const std::string& hint = "");
  void warn(int line, const std::string& text);
  // Elements of one name in one parent make one warning with all their lines.
  void leave_out(const XmlElement& element, const std::string& parent);

  // Names as left out what is in neither list, and children that stand twice where there is but one (<inertial>).
  // Attributes of the namespace (xmlns:...) say nothing.
  void expect(const XmlElement& element, std::initializer_list<const char*> attributes,
              std::initializer_list<const char*> children);

  // An attribute that must be there and not be empty; "" and a mistake otherwise.
  std::string name_of(const XmlElement& element, const char* attribute);
  // required: a mistake where it is missing. Else `otherwise` is what a missing one means. A value that is no
  // number is a mistake. endless: "inf" is a number as well.
  double number(const XmlElement& element, const char* attribute, double otherwise, bool required = false,
                bool endless = false);
  Vec3 vector(const XmlElement& element, const char* attribute, const Vec3& otherwise, bool required = false);
  // Three numbers; a fourth of 1, as of homogeneous coordinates, is left out with a warning.
  Vec3 scale(const XmlElement& element);
  // As many numbers as there are; empty, and no mistake: one of them is no number.
  static std::vector<double> numbers_in(const std::string& text);
  // Of the child <origin>; without it the identity. unit: m, rad
  Pose origin(const XmlElement& element);

  bool fine() const { return mistakes_.empty(); }
  void throw_mistakes();
  // In order of their lines.
  std::vector<std::string> take_warnings();

 private:
  void not_a_number(const XmlElement& element, const std::string& attribute, const std::string& expected,
                    const std::string& found);

  std::string path_, owner_;
  std::vector<Diagnostic> mistakes_;
  std::vector<std::pair<int, std::string>> warnings_;       // line, text
  std::map<std::pair<std::string, std::string>, std::vector<int>> left_out_;  // by parent and element: lines
};

// The links and joints of a URDF file in the order of their tree.

// A joint with the names of its links, before the tree is known.
struct UrdfNamedJoint {
  UrdfJoint joint;            // without parent and child
  std::string parent, child;  // names of links
  bool floating = false;
};

// Fills links, joints and `fixed` of the file: the root first, parents before children, siblings by the names of their
// joints, as liburdfdom and pinocchio order them. Throws InputError with every mistake: names that are there twice, ends
// of joints that are not there, loops, several roots, floating joints anywhere but below an empty root.
void order_urdf_tree(UrdfElements& elements, std::vector<UrdfLink> links, std::vector<UrdfNamedJoint> joints, UrdfFile& file);

// Where the mesh files that a URDF file names lie on this machine.
// name: as the file has it: relative, absolute, "package://PACKAGE/PATH", "model://MODEL/PATH" or "file://PATH",
// with %20 and the like. Relative names and packages are looked for in the folder of the URDF file and in those
// that it lies in, whether or not PACKAGE is a folder there, then in $ROS_PACKAGE_PATH and $AMENT_PREFIX_PATH.
// Absolute paths are often those of another machine: their last folders are looked for as relative names are.
// Empty: there is no such file.
std::string find_urdf_mesh(const std::string& name, const std::string& urdf_path);

}  // namespace rubble
