// The words of a Lua 5.4 source text, each with its line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rubble {

struct LuaToken {
  enum class Kind { name, keyword, number, string, symbol, end };
  Kind kind = Kind::end;  // what `text` is
  std::string text;       // of a short string without escapes: its content; of others the source
  int line = 1;           // of its first character; 1-based

  bool is(const char* symbol_or_keyword) const {
    return (kind == Kind::symbol || kind == Kind::keyword) && text == symbol_or_keyword;
  }
};

// For a text that Lua has accepted; a bad one gives some tokens and never fails. The last token is
// `end`.
std::vector<LuaToken> read_lua_tokens(std::string_view text);

}  // namespace rubble
