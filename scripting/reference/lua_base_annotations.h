// The functions of the closed environment that are written in C++ or in the prelude, annotated by hand;
// a test compares their names with those that a script sees.
#pragma once

namespace rubble {

extern const char* const kLuaBaseAnnotations;

}  // namespace rubble
