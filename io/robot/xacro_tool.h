// Robots in xacro, the macro language of ROS: expanded by the tool of that name, where it is installed.
//
// The tool evaluates expressions of the file and reads what the file includes, as it does for a launch file: a
// xacro file is a program of its author, which a URDF file is not.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/base/xml_document.h"

namespace rubble {

// By its name, which ends in ".xacro".
bool is_xacro_file(const std::string& path);

// The first element of xacro's, or one with an expression of xacro in an attribute; null: it is plain URDF.
const XmlElement* find_xacro(const XmlElement& root);

// What `xacro PATH NAME:=VALUE ...` prints. first: what needs it, for the message. Throws InputError: there is no
// such tool on the PATH, or it fails, with what it says; it takes more than two minutes; or there is a sandbox
// (kernel/base/system/file_sandbox.h), in which it is not called.
std::string expand_xacro(const std::string& path, const XmlElement& first,
                         const std::vector<std::pair<std::string, std::string>>& arguments);

}  // namespace rubble
