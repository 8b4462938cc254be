// Values as a script would hold them.
#pragma once

#include <string>

#include "scripting/values/value.h"

namespace rubble {

// "" for nil and for an empty text.
std::string lua_text(const Value& value);

}  // namespace rubble
