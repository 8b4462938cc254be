#include "scripting/sandbox/lua_library.h"

#include <memory>
#include <new>

#include "kernel/base/error.h"
#include "scripting/sandbox/lua_api.h"

namespace rubble {
namespace {

int append_code(lua_State*, const void* bytes, size_t size, void* code) {
  static_cast<std::string*>(code)->append(static_cast<const char*>(bytes), size);
  return 0;
}

std::map<std::string, std::string> compile_library() {
  std::map<std::string, std::string> codes;
  const std::unique_ptr<lua_State, void (*)(lua_State*)> lua(luaL_newstate(), lua_close);
  if (!lua) throw std::bad_alloc();
  for (const LibraryFile& file : lua_library()) {
    const std::string chunk = "=library " + file.name;
    if (luaL_loadbufferx(lua.get(), file.text.data(), file.text.size(), chunk.c_str(), "t") !=
        LUA_OK)
      throw RunError(lua_tostring(lua.get(), -1));
    lua_dump(lua.get(), append_code, &codes[file.name], 0);
    lua_settop(lua.get(), 0);
  }
  return codes;
}

}  // namespace

const std::map<std::string, std::string>& compiled_library() {
  static const std::map<std::string, std::string> codes = compile_library();
  return codes;
}

}  // namespace rubble
