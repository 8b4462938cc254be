// Words and numbers of the text formats of meshes (OBJ, MTL, STL), independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

// The tags of an XML document one after the other, for formats of few elements. No namespaces are resolved, no entities
// but the five of XML and numbers.
class XmlScanner {
 public:
  explicit XmlScanner(std::string_view xml) : rest_(xml), all_(xml) {}

  // The next tag; false: the end, or a tag that is not closed.
  bool next();

  const std::string_view& name() const { return name_; }  // with its prefix: "m:colorgroup"
  bool closes() const { return closes_; }                 // </name>
  bool is_empty() const { return empty_; }                // <name/>
  // Of the tag; empty: none.
  std::string attribute(std::string_view name) const;
  const std::vector<std::pair<std::string_view, std::string_view>>& attributes() const { return attributes_; }
  int line() const;  // of the tag; 1-based
  // Between the tag before and this one, without comments; of CDATA the content.
  std::string text() const;

 private:
  void read_attributes(std::string_view tag);

  std::string_view rest_, all_, name_;
  std::size_t text_ = 0, at_ = 0;  // where the text before the tag begins, and the tag
  std::vector<std::pair<std::string_view, std::string_view>> attributes_;
  bool closes_ = false, empty_ = false;
};

// Where markup that begins at `at` ends, quotes heeded: a tag, comment, CDATA or declaration.
std::size_t end_of_markup(std::string_view xml, std::size_t at);

}  // namespace rubble
