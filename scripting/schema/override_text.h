// The text of a --set argument after its sign of equality.
#pragma once

#include <string>

#include "scripting/schema/schema.h"

namespace rubble {

// What the text means depends on the key: "7" is a fine name for an asset. A list has commas and may have braces; a word may
// have quotation marks, as in Lua: {"concrete", 'residential'}. Text that does not fit the key comes back as text.
Value parse_override(const Slot& slot, const std::string& text);

}  // namespace rubble
