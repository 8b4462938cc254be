// Words and numbers of the text formats of meshes (OBJ, MTL, STL), independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/base/tables/text_table.h"

namespace rubble {

// Lines of a text with LF, CRLF or CR; a backslash at the end of a line joins the next one to it. A byte order mark at
// the begin is skipped.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text, bool joins_lines = true);
  bool next();  // false: the end
  std::string_view line() const { return joined_.empty() ? line_ : std::string_view(joined_); }
  int number() const { return first_; }  // of the first physical line; 1-based

 private:
  bool take();

  std::string_view rest_, line_;
  std::string joined_;
  bool joins_lines_;
  int lines_ = 0, first_ = 0;
};

// Takes the next word, without the blanks around it; empty: the end.
std::string_view take_word(std::string_view& text);
std::vector<std::string_view> split_words(std::string_view text);

// The value of a decimal number: "-1.5", ".5", "5.", "+2", "1e-3", "nan". Nothing: it is no number.
// A number of at most five digits before the point and no exponent is the sum of its whole part and its fraction, each
// rounded to single precision. Vertices of the bundled packs have had these bits since the first version, and every
// settled pile depends on them; the difference is at most half a unit in the last place.
std::optional<double> read_real(std::string_view word);
std::optional<std::int64_t> read_integer(std::string_view word);

}  // namespace rubble
