#include "scripting/sandbox/lua_value.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr int kDeepest = 16;
constexpr int kMostValues = 1'000'000;
constexpr std::size_t kMostText = std::size_t(16) << 20;  // unit: byte

Value other(std::string words) {
  Value v = Value::of_kind(Value::Kind::other);
  v.text = std::move(words);
  return v;
}

class Reader {
 public:
  explicit Reader(lua_State* lua) : lua_(lua) {}

  // The values read, a long string counting for several.
  std::size_t cost() const { return std::size_t(count_) + bytes_ / 64; }

  Value read(int index, int depth) {
    if (++count_ > kMostValues) return other("too many values");
    switch (lua_type(lua_, index)) {
      case LUA_TNIL:
        return {};
      case LUA_TBOOLEAN:
        return Value::make_boolean(lua_toboolean(lua_, index) != 0);
      case LUA_TNUMBER:
        return lua_isinteger(lua_, index) ? Value::make_integer(lua_tointeger(lua_, index))
                                          : Value::make_number(lua_tonumber(lua_, index));
      case LUA_TSTRING:
        return read_text(index);
      case LUA_TTABLE:
        return depth < kDeepest ? read_table(index, depth) : other("tables too deep");
      default:
        return other(std::string("a ") + luaL_typename(lua_, index));
    }
  }

 private:
  Value read_text(int index) {
    const std::string_view text = text_at(index);
    bytes_ += text.size();
    if (bytes_ > kMostText) return other("strings of more than 16 MiB in all");
    if (find_invalid_utf8(text) != std::string_view::npos)
      return other("a string that is not UTF-8");
    if (text.find('\0') != std::string_view::npos) return other("a string with a zero byte");
    return Value::make_text(std::string(text));
  }

  std::string_view text_at(int index) {
    std::size_t size = 0;
    const char* const text = lua_tolstring(lua_, index, &size);
    return {text, size};
  }

  // Of a field: made to be shown, for what is not UTF-8, has a zero byte or is beyond all bounds is no key of ours.
  std::string read_name(int index) {
    const std::string_view text = text_at(index);
    bytes_ += text.size();
    const bool whole = bytes_ <= kMostText && find_invalid_utf8(text) == std::string_view::npos &&
                       text.find('\0') == std::string_view::npos;
    return whole ? std::string(text) : printable(text.substr(0, 64));
  }

  Value read_table(int index, int depth) {
    luaL_checkstack(lua_, 4, "reading a table");
    const int table = lua_absindex(lua_, index);
    Value value = Value::make_table();
    std::map<lua_Integer, Value> numbered;
    for (lua_pushnil(lua_); lua_next(lua_, table) != 0; lua_pop(lua_, 1)) {
      if (lua_isinteger(lua_, -2))
        numbered.emplace(lua_tointeger(lua_, -2), read(-1, depth + 1));
      else if (lua_type(lua_, -2) == LUA_TSTRING)
        value.fields.emplace_back(read_name(-2), read(-1, depth + 1));
      else
        value.strange_keys.push_back(lua_type(lua_, -2) == LUA_TNUMBER
                                         ? "the key " + describe(read(-2, kDeepest))
                                         : std::string("a key that is a ") +
                                               luaL_typename(lua_, -2));
    }
    std::sort(value.fields.begin(), value.fields.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [key, item] : numbered) {
      if (key == lua_Integer(value.items.size()) + 1)
        value.items.push_back(std::move(item));
      else
        value.strange_keys.push_back("the key " + std::to_string(key));
    }
    std::sort(value.strange_keys.begin(), value.strange_keys.end());
    return value;
  }

  lua_State* lua_;
  int count_ = 0;
  std::size_t bytes_ = 0;  // of strings
};

}  // namespace

Value read_lua_value(lua_State* lua, int index, std::size_t* count) {
  Reader reader(lua);
  Value value = reader.read(index, 0);
  if (count) *count += reader.cost();
  return value;
}

std::string text_argument(lua_State* lua, int index) {
  std::size_t size = 0;
  const char* const text = luaL_checklstring(lua, index, &size);
  luaL_argcheck(lua, std::string_view(text, size).find('\0') == std::string_view::npos, index, "a string without a zero byte expected");
  return {text, size};
}

void push_lua_value(lua_State* lua, const Value& value) {
  luaL_checkstack(lua, 4, "making a table");
  switch (value.kind) {
    case Value::Kind::nil:
      return lua_pushnil(lua);
    case Value::Kind::boolean:
      return lua_pushboolean(lua, value.boolean);
    case Value::Kind::integer:
      return lua_pushinteger(lua, value.integer);
    case Value::Kind::number:
      return lua_pushnumber(lua, value.number);
    case Value::Kind::text:
      lua_pushlstring(lua, value.text.data(), value.text.size());
      return;
    case Value::Kind::other:
      luaL_error(lua, "a table of plain values expected, found %s in it", value.text.c_str());
      return;
    case Value::Kind::table:
      break;
  }
  lua_createtable(lua, int(value.items.size()), int(value.fields.size()));
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    push_lua_value(lua, value.items[i]);
    lua_rawseti(lua, -2, lua_Integer(i) + 1);
  }
  for (const auto& [name, member] : value.fields) {
    push_lua_value(lua, member);
    lua_setfield(lua, -2, name.c_str());
  }
}

}  // namespace rubble
