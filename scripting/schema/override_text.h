// The text of a --set argument after its sign of equality.
#pragma once

#include <string>

#include "scripting/schema/schema.h"

namespace rubble {

// What the text means depends on the key: "7" is a fine name for an asset. A list has commas and may have braces; a word may
// have quotation marks, as in Lua: {"concrete", 'residential'}. Text that does not fit the key comes back as text.
Value parse_override(const Slot& slot, const std::string& text);

// The whole path of the key that "KEY=VALUE" sets: "lamp.on" of "lamp=false", "pile.layers" of its alias "numlayers=3". Of an
// unknown key as it is written.
std::string override_path(const Schema& schema, const std::string& text);

// Whether a path is `whole`, or of a part of it: "pile.mix[1].weight" of "pile.mix".
bool is_within(const std::string& path, const std::string& whole);

}  // namespace rubble
