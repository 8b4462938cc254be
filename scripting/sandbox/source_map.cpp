#include "scripting/sandbox/source_map.h"

#include <charconv>

#include "scripting/sandbox/lua_tokens.h"

namespace rubble {
namespace {

constexpr std::size_t kDeepestPath = 64;  // open brackets; no schema goes as deep
constexpr int kMostHops = 16;             // through variables that stand for variables

std::string child(const std::string& parent, const std::string& key) {
  return key.empty() || key[0] == '[' ? parent + key : parent + "." + key;
}

bool begins_with(const std::string& text, const std::string& prefix) {
  return text.rfind(prefix, 0) == 0;
}

// Where the last part of a path begins: "$.pile.mix[2]" -> the position of "[2]".
std::size_t last_part(const std::string& path) { return path.find_last_of(".["); }

}  // namespace

// Walks the tokens once, with a stack of the brackets and blocks that are open.
class SourceMap::Builder {
 public:
  Builder(SourceMap& map, std::string_view text, const std::string& entry)
      : map_(map), tokens_(read_lua_tokens(text)), entry_(entry) {}

  void run() {
    for (i_ = 0; token().kind != LuaToken::Kind::end; ++i_) {
      if (in_table() && stack_.back().at_field_start) read_field_start();
      read_token();
    }
    for (Duplicate& d : found_duplicates_) {
      if (!begins_with(d.key, "$")) continue;
      const std::size_t start = d.key.size() > 1 && d.key[1] == '.' ? 2 : 1;
      map_.duplicates_.push_back({d.key.substr(start), d.line, d.first_line});
    }
  }

 private:
  enum class Open { table, round, square, block };
  struct Frame {
    Open open;
    std::string path;  // of a table; empty: a table that no path leads to
    int items = 0;
    bool at_field_start = true;
    std::map<std::string, int> written = {};  // key -> line
  };

  const LuaToken& token(std::size_t ahead = 0) const {
    return tokens_[std::min(i_ + ahead, tokens_.size() - 1)];
  }
  bool in_table() const { return !stack_.empty() && stack_.back().open == Open::table; }
  bool is_name(std::size_t ahead) const { return token(ahead).kind == LuaToken::Kind::name; }

  // At the start of a field: notes its key and moves to the first token of its value.
  void read_field_start() {
    if (token().is("}") || token().is(",") || token().is(";")) return;
    Frame& frame = stack_.back();
    frame.at_field_start = false;
    const int line = token().line;
    std::string key;
    if (is_name(0) && token(1).is("=")) {
      key = token().text;
      i_ += 2;
    } else if (token().is("[") && token(2).is("]") && token(3).is("=")) {
      key = token(1).kind == LuaToken::Kind::number ? "[" + token(1).text + "]" : token(1).text;
      i_ += 4;
    } else {
      key = "[" + std::to_string(++frame.items) + "]";
    }
    if (frame.path.empty()) return;
    const std::string path = child(frame.path, key);
    const auto [first, is_new] = frame.written.emplace(key, line);
    if (!is_new) found_duplicates_.push_back({path, line, first->second});
    note_value(path, line, [](const LuaToken& t) { return t.is(",") || t.is(";") || t.is("}"); });
  }

  // Notes a path whose value begins at the token here.
  template <typename EndsValue>
  void note_value(const std::string& path, int line, EndsValue ends_value) {
    map_.lines_[path] = line;
    map_.aliases_.erase(path);
    pending_ = path;
    std::size_t n = 0;
    const std::string name = dotted_name(n);
    if (!name.empty() && ends_value(token(n))) map_.aliases_[path] = name;
    if (token().kind == LuaToken::Kind::number && ends_value(token(1)))
      map_.literals_[path] = token().text;
    else
      map_.literals_.erase(path);
  }

  // "a.b.c" at the token here, and how many tokens it has. Empty: none, or one that is longer than
  // any path of ours; to follow it would take time by the square of its length.
  std::string dotted_name(std::size_t& count) const {
    count = 0;
    if (!is_name(0)) return {};
    std::string name = token().text;
    count = 1;
    while (token(count).is(".") && is_name(count + 1)) {
      if (count / 2 < kDeepestPath) name += "." + token(count + 1).text;
      count += 2;
    }
    if (count / 2 >= kDeepestPath) return {};
    return map_.resolve(name);
  }

  void read_token() {
    const LuaToken& t = token();
    if (t.is("{")) return open_table();
    if (t.is("(")) return stack_.push_back({Open::round, ""});
    if (t.is("[")) return stack_.push_back({Open::square, ""});
    if (t.is("function") || t.is("if") || t.is("do") || t.is("repeat"))
      return stack_.push_back({Open::block, ""});
    if (t.is("}") || t.is(")") || t.is("]") || t.is("end") || t.is("until")) return close();
    if (in_table()) {
      if (t.is(",") || t.is(";")) stack_.back().at_field_start = true;
      if (!is_entry_call()) return;
    }
    read_statement_part();
  }

  void open_table() {
    std::string path = std::move(pending_);
    pending_.clear();
    // A value such as `f { ... }` is what f makes of its table, which need not be that table.
    if (!path.empty() && i_ > 0 && is_call_argument()) path.clear();
    if (root_comes_) path = "$", root_comes_ = false;
    if (stack_.size() > kDeepestPath) path.clear();
    stack_.push_back({Open::table, path});
  }

  bool is_call_argument() const {
    const LuaToken& before = tokens_[i_ - 1];
    return before.kind == LuaToken::Kind::name || before.is(")") || before.is("]");
  }

  void close() {
    if (!stack_.empty()) stack_.pop_back();
    pending_.clear();
  }

  bool is_entry_call() const {
    return is_name(0) && token().text == entry_ &&
           (token(1).is("{") || (token(1).is("(") && (token(2).is("{") || is_name(2))));
  }

  void read_statement_part() {
    if (is_entry_call()) return read_entry_call();
    if (token().is("return") && top_level()) return read_return();
    if (!is_name(0) || (i_ > 0 && tokens_[i_ - 1].is("."))) return;
    std::size_t n = 0;
    const std::string name = dotted_name(n);
    if (!token(n).is("=") || name.empty()) return;
    const int line = token().line;
    i_ += n + 1;
    note_value(name, line, [line](const LuaToken& t) {
      return t.line > line || t.kind == LuaToken::Kind::end || t.is(";") || t.is("end");
    });
    --i_;  // the loop goes on with the value
  }

  bool top_level() const { return stack_.empty(); }

  void read_entry_call() {
    map_.root_line_ = token().line;
    const bool parenthesis = token(1).is("(");
    if (parenthesis && is_name(2)) {
      i_ += 2;
      std::size_t n = 0;
      const std::string name = dotted_name(n);
      if (!name.empty()) map_.aliases_["$"] = name;
      i_ -= 2;
    } else {
      // `local m = rubble.mission { ... }`: m is another name of the returned table.
      if (!pending_.empty()) map_.aliases_[pending_] = "$", map_.lines_.erase(pending_);
      root_comes_ = true;
    }
    pending_.clear();
  }

  void read_return() {
    pending_.clear();  // `p.layers = 2 return rubble.mission { ... }`: 2 is not the mission
    if (map_.root_line_ == 0) map_.root_line_ = token().line;
    if (token(1).is("{")) root_comes_ = true;
    ++i_;
    std::size_t n = 0;
    const std::string name = dotted_name(n);
    --i_;
    const bool whole = !name.empty() && (token(n + 1).kind == LuaToken::Kind::end || token(n + 1).is(";"));
    if (whole && name != "$") map_.aliases_["$"] = name;
  }

  SourceMap& map_;
  std::vector<LuaToken> tokens_;
  std::string entry_;
  std::size_t i_ = 0;
  std::vector<Frame> stack_;
  std::string pending_;      // the path whose value comes next
  bool root_comes_ = false;  // the next table is the returned one
  std::vector<Duplicate> found_duplicates_;
};

SourceMap::SourceMap(std::string_view text, const std::string& entry) {
  Builder(*this, text, entry).run();
}

// Follows variables: "$.pile.layers" -> "p.layers" where `pile = p` was written.
std::string SourceMap::resolve(const std::string& path) const {
  std::string now = path;
  for (int hop = 0; hop < kMostHops; ++hop) {
    std::size_t end = now.size();
    bool moved = false;
    while (!moved && end != std::string::npos && end > 0) {
      const auto at = aliases_.find(now.substr(0, end));
      if (at != aliases_.end() && lines_.count(now) == 0) {
        now = at->second + now.substr(end);
        moved = true;
      } else {
        end = now.substr(0, end).find_last_of(".[");
      }
    }
    if (!moved) break;
  }
  return now;
}

int SourceMap::line_of(const std::string& key) const {
  for (std::string path = child("$", key);;) {
    for (const std::string& candidate : {path, resolve(path)}) {
      const auto at = lines_.find(candidate);
      if (at != lines_.end()) return at->second;
    }
    const std::size_t cut = last_part(path);
    if (cut == std::string::npos || cut == 0) return root_line_;
    path.resize(cut);
  }
}

std::optional<std::int64_t> SourceMap::literal_of(const std::string& key) const {
  for (const std::string& path : {child("$", key), resolve(child("$", key))}) {
    const auto at = literals_.find(path);
    if (at == literals_.end()) continue;
    std::int64_t value = 0;
    const char* const end = at->second.data() + at->second.size();
    const auto result = std::from_chars(at->second.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end) return value;
  }
  return std::nullopt;
}

}  // namespace rubble
