-- rubble.join(a, b, ...): one pile from several. Their pieces stand beside each other. What falls is drawn from
-- the first mix, in a box over all spawn boxes, as many pieces as they have together, in as many layers as the part with
-- most. Parts with different layers whose pieces do not fill these evenly are refused. At most one part has a building,
-- and one a terrain.
local known = {
  placed = true, layers = true, pieces_per_layer = true, mix = true, spawn_position = true, spawn_bounds = true,
  spawn_density = true, building = true, terrain = true,
}
local falling = { "pieces_per_layer", "mix", "spawn_position", "spawn_bounds", "spawn_density" }
-- What a pile has where it says nothing of them, as in a mission.
local default = { layers = 4, pieces_per_layer = 300, spawn_position = { 0, 0, 4.5 }, spawn_bounds = { 10, 10, 7 } }

local most = { layers = 1000, pieces_per_layer = 100000 }  -- as in a mission
local most_cells = 100  -- along each side of a density that is joined with another: a script has a limit of work

-- At the script's line: from a function that the joining one calls.
local function fail(text) error("rubble.join: " .. text, 4) end

local function is_finite(v) return type(v) == "number" and math.abs(v) < math.huge end

-- {x, y, z} of a vector in either way of writing it, or of a mission's default.
local function listed(i, part, key)
  local v = part[key] or default[key]
  local list = type(v) == "table" and { v[1] or v.x, v[2] or v.y, v[3] or v.z } or {}
  for k = 1, 3 do
    if not is_finite(list[k]) or (key == "spawn_bounds" and list[k] <= 0) then
      fail("the " .. key .. " of part " .. i .. " is not three numbers {x, y, z}" .. (key == "spawn_bounds" and " above 0" or ""))
    end
  end
  return list
end

-- `layers` or `pieces_per_layer` of a part, or of a mission's default.
local function count_of(i, part, key)
  local value = part[key]
  if value == nil then value = default[key] end
  local count = type(value) == "number" and math.tointeger(value)
  if not count or count < 0 or count > most[key] then
    fail("part " .. i .. " has " .. key .. " = " .. tostring(value) .. ": expected a whole number from 0 to " .. most[key])
  end
  return count
end

local function check(i, part)
  if type(part) ~= "table" then fail("part " .. i .. " is no pile but a " .. type(part)) end
  for key in pairs(part) do
    if not known[key] then
      fail("part " .. i .. " has the key \"" .. tostring(key) .. "\", which no pile has, or which it cannot join")
    end
  end
end

-- Layers of a part. One that says nothing of what falls drops nothing.
local function layers_of(i, part)
  if part.layers ~= nil then return count_of(i, part, "layers") end
  for _, key in ipairs(falling) do
    if part[key] then return default.layers end
  end
  return 0
end

-- The pieces that a part places, at the end of those of the parts before.
local function place(pile, i, part)
  if part.placed ~= nil and type(part.placed) ~= "table" then
    fail("the `placed` of part " .. i .. " is no list of pieces but a " .. type(part.placed))
  end
  local count = 0
  for key, item in pairs(part.placed or {}) do
    count = count + 1
    if key ~= count then
      fail("the `placed` of part " .. i .. " has the key " .. tostring(key) .. ": expected a list of pieces {{...}, {...}}")
    end
    pile.placed[#pile.placed + 1] = item
  end
end

-- Layers and pieces in each of all parts together. Each part has its share of every layer: `count` becomes that.
local function spread_over_layers(parts)
  local layers, total, found = 0, 0, ""
  for k, part in ipairs(parts) do
    total = total + part.layers * part.count
    if part.count > 0 then layers = math.max(layers, part.layers) end
    found = found .. (k > 1 and ", " or "") .. part.layers .. " x " .. part.count
  end
  if total == 0 then return parts[1].layers, 0 end
  if total % layers ~= 0 then
    fail(total .. " pieces (" .. found .. ") do not fill " .. layers .. " layers evenly: give all parts the same number of `layers`")
  end
  for _, part in ipairs(parts) do part.count = part.layers * part.count / layers end
  return layers, total // layers
end

-- Takes the one thing of its kind that a joined pile can have.
local function take(pile, from, key, i, part)
  if not part[key] then return end
  if pile[key] and pile[key] ~= part[key] then
    fail("parts " .. from[key] .. " and " .. i .. " both have a " .. key .. ": a pile has one at most")
  end
  pile[key], from[key] = part[key], from[key] or i
end

local function add_cell(weights, columns, column, row, share)
  local i = row * columns + column + 1
  weights[i] = weights[i] + share
end

-- The cells first, ..., last of `count` on [low, high] that [from, to] meets, with the share of it in each.
local function shares(low, high, count, from, to)
  local size, list = (high - low) / count, {}
  local first = math.max(0, math.min(count - 1, math.floor((from - low) / size)))
  local last = math.max(first, math.min(count - 1, math.ceil((to - low) / size) - 1))
  for k = first, last do
    local a, b = math.max(from, low + k * size), math.min(to, low + (k + 1) * size)
    if k == first then a = from end
    if k == last then b = to end
    list[#list + 1] = { k, (b - a) / (to - from) }
  end
  return list
end

-- One grid over the box of all: each part has as many pieces in its own box as alone, on average, spread as alone.
local function join_densities(parts, low, high)
  local cell = { math.huge, math.huge }
  for _, part in ipairs(parts) do
    local d = part.density or { columns = 1, rows = 1 }
    cell[1] = math.min(cell[1], part.bounds[1] / d.columns)
    cell[2] = math.min(cell[2], part.bounds[2] / d.rows)
  end
  local columns = math.max(1, math.min(most_cells, math.ceil((high[1] - low[1]) / cell[1] - 1e-9)))
  local rows = math.max(1, math.min(most_cells, math.ceil((high[2] - low[2]) / cell[2] - 1e-9)))
  local weights = {}
  for i = 1, columns * rows do weights[i] = 0 end
  for _, part in ipairs(parts) do
    local d = part.density or { columns = 1, rows = 1, weights = { 1 } }
    if math.max(d.columns, d.rows) > most_cells then
      fail("a spawn_density of " .. d.columns .. " x " .. d.rows .. " cells cannot be joined with what else falls: "
        .. most_cells .. " x " .. most_cells .. " at most")
    end
    local sum = 0
    for _, w in ipairs(d.weights) do
      if not is_finite(w) or w < 0 then fail("a spawn_density has the weight " .. tostring(w) .. ": expected a number of at least 0") end
      sum = sum + w
    end
    if not (sum > 0) then fail("a spawn_density has no weight above 0") end
    local x0, y0 = part.position[1] - part.bounds[1] / 2, part.position[2] - part.bounds[2] / 2
    local dx, dy = part.bounds[1] / d.columns, part.bounds[2] / d.rows
    local along_x, along_y = {}, {}
    for c = 0, d.columns - 1 do along_x[c] = shares(low[1], high[1], columns, x0 + c * dx, x0 + (c + 1) * dx) end
    for r = 0, d.rows - 1 do along_y[r] = shares(low[2], high[2], rows, y0 + r * dy, y0 + (r + 1) * dy) end
    for r = 0, d.rows - 1 do
      for c = 0, d.columns - 1 do
        local w = d.weights[r * d.columns + c + 1]
        if w > 0 then
          local all = w / sum * part.count
          for _, y in ipairs(along_y[r]) do
            for _, x in ipairs(along_x[c]) do add_cell(weights, columns, x[1], y[1], all * x[2] * y[2]) end
          end
        end
      end
    end
  end
  return { columns = columns, rows = rows, weights = weights }
end

-- Of a density of a part: its grid has as many weights as it says.
local function density_of(i, part)
  local d = part.spawn_density
  if not d then return nil end
  if type(d) ~= "table" or (d.weights ~= nil and type(d.weights) ~= "table") then
    fail("the spawn_density of part " .. i .. " is no grid of weights, as rubble.density makes it")
  end
  if not d.weights or #d.weights == 0 then return nil end
  if not is_finite(d.columns) or not is_finite(d.rows) or #d.weights ~= d.columns * d.rows then
    fail("the spawn_density of part " .. i .. " has " .. #d.weights .. " weights, not columns times rows")
  end
  return d
end

return function(...)
  local pile, from, parts = { placed = {}, layers = 0, pieces_per_layer = 0 }, {}, {}
  local low, high, dense = { 1e9, 1e9, 1e9 }, { -1e9, -1e9, -1e9 }, false
  for i = 1, select("#", ...) do
    local part = select(i, ...)
    check(i, part)
    place(pile, i, part)
    take(pile, from, "building", i, part)
    take(pile, from, "terrain", i, part)
    local layers = layers_of(i, part)
    if layers > 0 then
      local p, b = listed(i, part, "spawn_position"), listed(i, part, "spawn_bounds")
      parts[#parts + 1] = {
        mix = part.mix, position = p, bounds = b, layers = layers, count = count_of(i, part, "pieces_per_layer"),
        density = density_of(i, part),
      }
      dense = dense or parts[#parts].density ~= nil
      for k = 1, 3 do
        low[k], high[k] = math.min(low[k], p[k] - b[k] / 2), math.max(high[k], p[k] + b[k] / 2)
      end
    end
  end
  if #parts == 0 then return pile end
  pile.layers, pile.pieces_per_layer = spread_over_layers(parts)
  pile.mix, pile.spawn_position, pile.spawn_bounds = parts[1].mix, {}, {}
  for k = 1, 3 do
    pile.spawn_position[k] = (low[k] + high[k]) / 2
    pile.spawn_bounds[k] = high[k] - low[k]
  end
  dense = dense and pile.pieces_per_layer > 0
  if dense and #parts == 1 then pile.spawn_density = parts[1].density end
  if dense and #parts > 1 then pile.spawn_density = join_densities(parts, low, high) end
  return pile
end
