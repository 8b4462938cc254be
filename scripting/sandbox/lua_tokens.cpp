#include "scripting/sandbox/lua_tokens.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace rubble {
namespace {

constexpr const char* kKeywords[] = {"and",   "break", "do",       "else", "elseif", "end",
                                     "false", "for",   "function", "goto", "if",     "in",
                                     "local", "nil",   "not",      "or",   "repeat", "return",
                                     "then",  "true",  "until",    "while"};

// Longest first, so that the first that fits is the right one.
constexpr const char* kSymbols[] = {"...", "..", "::", "==", "~=", "<=", ">=", "//", "<<", ">>"};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

class Tokenizer {
 public:
  explicit Tokenizer(std::string_view text) : text_(text) {}

  std::vector<LuaToken> run() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") advance(3);  // a byte order mark
    if (at(0) == '#') skip_line();  // "#!/usr/bin/env ..."
    while (skip_blank(), position_ < text_.size()) read_one();
    add(LuaToken::Kind::end, "", line_);
    return std::move(tokens_);
  }

 private:
  char at(std::size_t offset) const {
    return position_ + offset < text_.size() ? text_[position_ + offset] : '\0';
  }

  void add(LuaToken::Kind kind, std::string_view text, int line) {
    tokens_.push_back({kind, std::string(text), line});
  }

  void advance(std::size_t count) {
    const std::size_t end = std::min(position_ + count, text_.size());
    line_ += int(std::count(text_.begin() + std::ptrdiff_t(position_),
                            text_.begin() + std::ptrdiff_t(end), '\n'));
    position_ = end;
  }

  void skip_line() { advance(std::min(text_.find('\n', position_), text_.size()) - position_); }

  void skip_blank() {
    while (position_ < text_.size()) {
      if (is_space(at(0)))
        advance(1);
      else if (at(0) == '-' && at(1) == '-')
        skip_comment();
      else
        return;
    }
  }

  void skip_comment() {
    advance(2);
    const std::size_t level = long_bracket_level();
    if (level > 0)
      advance(long_bracket_size(level));
    else
      skip_line();
  }

  // The length of "[[" or "[==[" here; 0 when there is none.
  std::size_t long_bracket_level() const {
    if (at(0) != '[') return 0;
    std::size_t n = 1;
    while (at(n) == '=') ++n;
    return at(n) == '[' ? n + 1 : 0;
  }

  std::size_t long_bracket_size(std::size_t level) const {
    const std::string close = "]" + std::string(level - 2, '=') + "]";
    const std::size_t end = text_.find(close, position_ + level);
    return end == std::string_view::npos ? text_.size() - position_
                                         : end + close.size() - position_;
  }

  void read_one() {
    const char c = at(0);
    if (is_word(c) && !is_digit(c)) return read_word();
    if (is_digit(c) || (c == '.' && is_digit(at(1)))) return read_number();
    if (c == '"' || c == '\'') return read_string(c);
    if (const std::size_t level = long_bracket_level()) {
      const int line = line_;
      const std::size_t size = long_bracket_size(level);
      add(LuaToken::Kind::string, text_.substr(position_, size), line);
      return advance(size);
    }
    read_symbol();
  }

  void read_word() {
    std::size_t n = 1;
    while (is_word(at(n))) ++n;
    const std::string_view word = text_.substr(position_, n);
    const bool keyword =
        std::any_of(std::begin(kKeywords), std::end(kKeywords), [&](auto k) { return word == k; });
    add(keyword ? LuaToken::Kind::keyword : LuaToken::Kind::name, word, line_);
    advance(n);
  }

  void read_number() {
    const bool hexadecimal = at(0) == '0' && (at(1) == 'x' || at(1) == 'X');
    std::size_t n = 1;
    while (is_word(at(n)) || at(n) == '.' ||
           ((at(n) == '+' || at(n) == '-') && is_exponent(at(n - 1), hexadecimal)))
      ++n;
    add(LuaToken::Kind::number, text_.substr(position_, n), line_);
    advance(n);
  }

  static bool is_exponent(char c, bool hexadecimal) {
    return hexadecimal ? c == 'p' || c == 'P' : c == 'e' || c == 'E';
  }

  void read_string(char quote) {
    const int line = line_;
    std::size_t n = 1;
    while (position_ + n < text_.size() && at(n) != quote) n += at(n) == '\\' ? 2 : 1;
    add(LuaToken::Kind::string, text_.substr(std::min(position_ + 1, text_.size()), n - 1), line);
    advance(n + 1);
  }

  void read_symbol() {
    for (const char* symbol : kSymbols) {
      const std::string_view s(symbol);
      if (text_.substr(position_, s.size()) != s) continue;
      add(LuaToken::Kind::symbol, s, line_);
      return advance(s.size());
    }
    add(LuaToken::Kind::symbol, text_.substr(position_, 1), line_);
    advance(1);
  }

  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
  std::vector<LuaToken> tokens_;
};

}  // namespace

std::vector<LuaToken> read_lua_tokens(std::string_view text) { return Tokenizer(text).run(); }

}  // namespace rubble
