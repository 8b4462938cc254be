// Numbers and tables as text that other programs wrote: the one lexer of all readers of such files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

// The text after the byte order mark of UTF-8, which Excel, Notepad and PowerShell write.
std::string_view skip_byte_order_mark(std::string_view text);

// Whether it begins with the byte order mark of UTF-16, which no reader here takes.
bool is_utf16(std::string_view text);

// A whole word as a number, in any locale: with a plus sign, `5.`, `.5`, an exponent after e, E, or
// Fortran's d or D, `nan` and `inf`. Numbers too small for a double are 0. nullopt: it is no number.
std::optional<double> parse_number(std::string_view word);

// The word times 10^digits, exactly where it is a decimal number without an exponent, rounded to the
// nearest. digits: 0 to 9; 9: seconds to nanoseconds. nullopt: no number, or too large.
std::optional<std::int64_t> parse_scaled_integer(std::string_view word, int digits);

// A line's words. Line ends are LF, CR LF or CR.
struct TextRow {
  int line = 0;                         // of the file; 1-based
  char separator = ' ';                 // ' ' for blanks and tabs, ',' or ';'
  std::vector<std::string_view> words;  // without blanks around them and without quotes; part of the text
};

struct TextTable {
  std::vector<TextRow> rows;      // all lines but empty ones and comments; what follows a # is left out
  std::vector<TextRow> comments;  // lines that begin with # or %, without these marks
};

// The text must outlive the table.
TextTable read_text_table(std::string_view text);

// The lines as they are, without their ends; a byte order mark is skipped.
std::vector<std::string_view> split_lines(std::string_view text);

// A line between semicolons where it has any, else between commas, else between blanks.
TextRow split_words(std::string_view text, int line);

// As ASCII: other letters stay.
std::string lower_case(std::string_view text);

// Without white space at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace rubble
