// The types of a key's value, by the words of the documents and of Lua's annotations.
#pragma once

#include <string>

#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {

struct SlotType {
  std::string word;  // of docs/reference/missions.md: "integer"
  std::string lua;   // of the annotations: "number[]"
};

// A new alternative of Slot without a type does not compile.
SlotType slot_type(const Slot& slot);

// Values as a script would hold them.
// "" for nil and for an empty text.
std::string lua_text(const Value& value);

}  // namespace rubble
