-- rubble.join(a, b, ...): one pile from several. Their pieces stand beside each other. What falls is drawn from
-- the first mix, in a box over all spawn boxes, as many pieces as they have together. At most one part has a
-- building, and one a terrain.
local known = {
  placed = true, layers = true, pieces_per_layer = true, mix = true, spawn_position = true, spawn_bounds = true,
  spawn_density = true, building = true, terrain = true,
}
local falling = { "pieces_per_layer", "mix", "spawn_position", "spawn_bounds", "spawn_density" }
-- What a pile has where it says nothing of them, as in a mission.
local default = { layers = 4, pieces_per_layer = 300, spawn_position = { 0, 0, 4.5 }, spawn_bounds = { 10, 10, 7 } }

local most_cells = 100  -- along each side of a density that is joined with another: a script has a limit of work

-- At the script's line: from a function that the joining one calls.
local function fail(text) error("rubble.join: " .. text, 4) end

-- {x, y, z} of a vector in either way of writing it.
local function listed(v) return { v[1] or v.x, v[2] or v.y, v[3] or v.z } end

local function check(i, part)
  if type(part) ~= "table" then fail("part " .. i .. " is no pile but a " .. type(part)) end
  for key in pairs(part) do
    if not known[key] then
      fail("part " .. i .. " has the key \"" .. tostring(key) .. "\", which no pile has, or which it cannot join")
    end
  end
end

-- Layers of a part. One that says nothing of what falls drops nothing.
local function layers_of(part)
  if part.layers then return part.layers end
  for _, key in ipairs(falling) do
    if part[key] then return default.layers end
  end
  return 0
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

-- One grid over the box of all: each part has as many pieces in its own box as alone, spread as alone.
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
    for _, w in ipairs(d.weights) do sum = sum + w end
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
  if not d or not d.weights or #d.weights == 0 then return nil end
  if #d.weights ~= (d.columns or 0) * (d.rows or 0) then
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
    for _, item in ipairs(part.placed or {}) do pile.placed[#pile.placed + 1] = item end
    take(pile, from, "building", i, part)
    take(pile, from, "terrain", i, part)
    local layers = layers_of(part)
    if layers > 0 then
      pile.layers = math.max(pile.layers, layers)
      local p = listed(part.spawn_position or default.spawn_position)
      local b = listed(part.spawn_bounds or default.spawn_bounds)
      local count = part.pieces_per_layer or default.pieces_per_layer
      pile.pieces_per_layer = pile.pieces_per_layer + count
      parts[#parts + 1] = { mix = part.mix, position = p, bounds = b, count = count, density = density_of(i, part) }
      dense = dense or parts[#parts].density ~= nil
      for k = 1, 3 do
        low[k], high[k] = math.min(low[k], p[k] - b[k] / 2), math.max(high[k], p[k] + b[k] / 2)
      end
    end
  end
  if #parts == 0 then return pile end
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
