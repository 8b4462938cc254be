// Between schemas, values and JSON text. The JSON library stays behind these functions.
#pragma once

#include <string>

#include "scripting/schema/schema.h"

namespace rubble {

// What a schema's members hold now, in the schema's order, indented by two spaces.
std::string members_to_json(const Schema& schema);

std::string value_to_json(const Value& value);  // lists as arrays, named fields as objects

// Throws InputError with the line when `text` is not JSON.
Value parse_json(const std::string& text, const std::string& file);

}  // namespace rubble
