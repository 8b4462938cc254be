#include "scripting/sandbox/lua_library.h"

namespace rubble {

const char* const kLuaPrelude = R"lua(
local host, entry = ...
local type, error, next, select, tostring, setmetatable = type, error, next, select, tostring, setmetatable
local floor, unpack, format, rep = math.floor, table.unpack, string.format, string.rep

-- Keeps only the named members: a new one of a later Lua version stays closed.
local function keep(library, names)
  local kept = {}
  for _, name in ipairs(names) do kept[name] = true end
  local gone = {}
  for name in next, library do if not kept[name] then gone[#gone + 1] = name end end
  for _, name in ipairs(gone) do library[name] = nil end
end

-- Stable merge sort, for Lua's own picks pivots by the clock when it meets a bad order.
local function sort(list, less)
  less = less or function(a, b) return a < b end
  local n, from, to, width = #list, {}, {}, 1
  for i = 1, n do from[i] = list[i] end
  while width < n do
    for low = 1, n, 2 * width do
      local middle, high = low + width, low + 2 * width
      if middle > n + 1 then middle = n + 1 end
      if high > n + 1 then high = n + 1 end
      local i, j = low, middle
      for k = low, high - 1 do
        if i < middle and (j >= high or not less(from[j], from[i])) then
          to[k] = from[i]; i = i + 1
        else
          to[k] = from[j]; j = j + 1
        end
      end
    end
    from, to, width = to, from, 2 * width
  end
  for i = 1, n do list[i] = from[i] end
end

-- Numbers, then strings, then booleans. Lua's own order of keys changes from run to run.
local rank = { number = 1, string = 2, boolean = 3 }
local function key_less(a, b)
  local ra, rb = rank[type(a)], rank[type(b)]
  if ra ~= rb then return ra < rb end
  if ra == 3 then return a == false and b == true end
  return a < b
end

local function sorted_pairs(t)
  if type(t) ~= "table" then error("pairs takes a table, not a " .. type(t), 2) end
  local keys = {}
  for key in next, t do
    if not rank[type(key)] then
      error("pairs cannot order a key that is a " .. type(key), 2)
    end
    keys[#keys + 1] = key
  end
  sort(keys, key_less)
  local i = 0
  return function()
    repeat i = i + 1 until keys[i] == nil or t[keys[i]] ~= nil
    if keys[i] ~= nil then return keys[i], t[keys[i]] end
  end
end

-- Without addresses, which change from run to run.
local plain = { string = true, number = true, boolean = true, ["nil"] = true }
local function plain_tostring(v)
  if plain[type(v)] then return tostring(v) end
  return type(v)
end

local function plain_format(text, ...)
  if type(text) ~= "string" then error("string.format takes a string first", 2) end
  local count = select("#", ...)
  local values = { ... }
  for i = 1, count do values[i] = plain[type(values[i])] and values[i] or plain_tostring(values[i]) end
  -- %p shows an address. Skip over %% first.
  local i = 1
  while i <= #text do
    if string.byte(text, i) == 37 then
      i = i + 1
      while i <= #text and string.byte(text, i) < 65 and string.byte(text, i) ~= 37 do i = i + 1 end
      if string.byte(text, i) == 112 then error("string.format: %p is not available", 2) end
    end
    i = i + 1
  end
  return format(text, unpack(values, 1, count))
end

local function safe_rep(text, count, separator)
  -- Lua would count through n empty strings.
  if #tostring(text) == 0 and #tostring(separator or "") == 0 then return "" end
  return rep(text, count, separator)
end

-- Vectors with arithmetic: tables {x =, y =, z =}. The metatable itself stays out of reach: a script
-- that could put __gc into it could run where no limit holds.
local vec, methods = {}, {}
vec.__index = methods
local function make_vec(x, y, z) return setmetatable({ x = x, y = y, z = z }, vec) end
local function raw_parts(v) return v.x or v[1], v.y or v[2], v.z or v[3] end
local function are_numbers(x, y, z) return type(x) == "number" and type(y) == "number" and type(z) == "number" end
local function parts(v)
  if type(v) ~= "table" then error("a vector is {x, y, z}, not a " .. type(v), 3) end
  local x, y, z = raw_parts(v)
  if not are_numbers(x, y, z) then error("a vector is three numbers {x, y, z}, not a table without them", 3) end
  return x, y, z
end
-- rubble.vec(x, y, z); rubble.vec() is zero.
local function vec_of(...)
  local count = select("#", ...)
  local x, y, z = ...
  if count == 0 then x, y, z = 0, 0, 0 end
  if count > 3 or not are_numbers(x, y, z) then
    local words = { ... }
    for i = 1, count do
      local word = plain_tostring(words[i])
      words[i] = type(words[i]) == "string" and '"' .. word .. '"' or word
    end
    error("rubble.vec: expected three numbers (x, y, z), found (" .. table.concat(words, ", ", 1, count) .. ")", 2)
  end
  return make_vec(x, y, z)
end
function vec.__add(a, b)
  local ax, ay, az = parts(a); local bx, by, bz = parts(b)
  return make_vec(ax + bx, ay + by, az + bz)
end
function vec.__sub(a, b)
  local ax, ay, az = parts(a); local bx, by, bz = parts(b)
  return make_vec(ax - bx, ay - by, az - bz)
end
function vec.__mul(a, b)
  if type(a) ~= "table" then a, b = b, a end
  if type(b) ~= "number" then
    local what = type(b) == "table" and "vector" or type(b)
    error("a vector times a " .. what .. ": expected a number; v:dot(w) and v:cross(w) multiply two vectors", 2)
  end
  local x, y, z = parts(a)
  return make_vec(x * b, y * b, z * b)
end
function vec.__unm(a) local x, y, z = parts(a); return make_vec(-x, -y, -z) end
function vec.__eq(a, b)
  local ax, ay, az = raw_parts(a); local bx, by, bz = raw_parts(b)
  return ax == bx and ay == by and az == bz
end
local function dot(a, b)
  local ax, ay, az = parts(a); local bx, by, bz = parts(b)
  return ax * bx + ay * by + az * bz
end
local sqrt = math.sqrt
methods.dot = dot
function methods.norm(a) return sqrt(dot(a, a)) end
function methods.cross(a, b)
  local ax, ay, az = parts(a); local bx, by, bz = parts(b)
  return make_vec(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
end

local streams = {}
local function stream(name)
  if type(name) ~= "string" then error("rubble.random takes the name of a stream", 3) end
  if not streams[name] then streams[name] = host.stream(name) end
  return streams[name]
end

-- Only a name for what the script returns; the reader says it when that is no table.
local function entry_function(t) return t end

keep(string, { "byte", "char", "len", "lower", "upper", "reverse", "sub" })
string.format, string.rep = plain_format, safe_rep
keep(table, { "concat", "insert", "pack", "remove", "unpack" })
table.sort = sort
keep(math, { "abs", "ceil", "deg", "floor", "fmod", "huge", "max", "maxinteger", "min", "mininteger",
             "modf", "pi", "rad", "sqrt", "tointeger", "type", "ult" })
for _, name in ipairs { "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log" } do
  math[name] = host[name]
end
function math.random(low, high)
  local r = stream("math.random")
  if not low then return r:uniform() end
  if not high then low, high = 1, low end
  return r:integer(low, high)
end
function math.randomseed() error("math.randomseed is closed: the seed is the mission's", 2) end

keep(_G, { "_G", "_VERSION", "assert", "error", "ipairs", "math", "select", "string", "table",
           "tonumber", "type" })
_G.pairs, _G.tostring = sorted_pairs, plain_tostring
function _G.print(...)
  local words = {}
  for i = 1, select("#", ...) do words[i] = plain_tostring((select(i, ...))) end
  host.print(table.concat(words, "\t"))
end

rubble = {
  random = stream,
  include = host.include,
  controller = host.controller,
  vec = vec_of,
  options = host.options,
  parameter = function(name, default, more)
    local entry = { name, default }
    if more ~= nil and type(more) ~= "table" then error("rubble.parameter takes its limits as a table", 2) end
    for key, value in next, more or {} do if type(key) == "string" then entry[key] = value end end
    return host.parameter(name, entry)
  end,
  reject = host.reject,
  read_table = host.read_table,
  read_image = host.read_image,
  read_trajectory = host.read_trajectory,
  read_accelerogram = host.read_accelerogram,
  read_calibration = host.read_calibration,
  rotate = function(rpy_deg, v) return make_vec(host.rotate(rpy_deg, v)) end,
}
if entry == "rubble.mission" then rubble.mission = entry_function else _G[entry] = entry_function end

-- Gives a function of the library its place: "collapse/heap" is rubble.collapse.heap.
return function(name, value)
  local place, i = rubble, 1
  while i <= #name do
    if string.byte(name, i) == 47 then
      local folder = string.sub(name, 1, i - 1)
      place[folder] = place[folder] or {}
      place, name = place[folder], string.sub(name, i + 1)
    end
    i = i + 1
  end
  place[name] = value
end
)lua";

}  // namespace rubble
