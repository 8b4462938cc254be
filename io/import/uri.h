// References from one file to another: URIs of glTF and names as programs of any system write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rubble {

// A name as a URL has it: "my%20wood.png".
std::string decode_percent(std::string_view text);

// The bytes of a data URI ("data:application/octet-stream;base64,..."). Nothing: it is none, or it is damaged.
std::optional<std::string> decode_data_uri(std::string_view uri);

// The path of a regular file of this name: relative to the folder as it is written, then percent-decoded, each with
// slashes for backslashes; then by its last part alone in the folder and, if not null, in this folder of it.
std::optional<std::string> find_beside(const std::string& folder, const std::string& name, const char* subfolder = nullptr);

}  // namespace rubble
