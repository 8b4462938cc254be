// Text that strangers wrote: whether it is UTF-8, and what of it may go to a terminal.
#pragma once

#include <string>
#include <string_view>

namespace rubble {

// The first byte that is not part of well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates,
// at most U+10FFFF); npos: there is none.
std::size_t find_invalid_utf8(std::string_view text);

// How deep the brackets of a JSON text are nested, those in strings left out. For texts that may be
// no JSON at all: whoever is to read it recursively asks first.
int calc_json_depth(std::string_view text);
inline constexpr int kDeepestJson = 200;

// The text without what steers a terminal: control characters but line feed and tab (ASCII's, and
// U+0080 to U+009F), and bytes that are not UTF-8, are written as \x1b.
std::string printable(std::string_view text);

// The same with line feeds and tabs written so, too: for formats in which a line or a row is a record.
std::string one_line(std::string_view text);

// What is wrong with a name that missions, messages and files of others get: "" for 1 to 100 bytes of UTF-8 without
// control characters and slashes that do not begin with a dot.
std::string find_name_fault(std::string_view name);
inline constexpr const char* kNameRule =
    "at most 100 bytes of UTF-8 without control characters and slashes that do not begin with a dot";

// A name of a file for any name, unlike those of other names: the name itself where it has no fault.
std::string file_name_of(std::string_view name);

}  // namespace rubble
