// The scripts of the page that shows a dataset, compiled in: app/view/viewer.js, and three.js as Debian
// has it. Made by CMake.
#pragma once

#include <string>

namespace rubble {

std::string viewer_code();
std::string three_code();  // empty where libjs-three was not installed when the program was built

}  // namespace rubble
