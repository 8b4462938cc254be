-- rubble.read_plan(file): the plan of a building, as `pile.building.plan` takes it. Each line of the file is
-- one part, its words between blanks or commas; `#` begins a comment. Lengths in metres.
--
--   storey HEIGHT                                    from the ground upwards, one line each
--   storeys FIRST LAST                               the lines after it are of these storeys; from 0
--   wall X1 Y1 X2 Y2 THICKNESS [MATERIAL]            its axis
--   window X1 Y1 X2 Y2 SILL HEAD                     on the axis of a wall, heights above the floor
--   door X1 Y1 X2 Y2 HEAD
--   column X Y WIDTH_X WIDTH_Y [MATERIAL]            its centre
--   beam X1 Y1 X2 Y2 WIDTH DEPTH [MATERIAL]          its axis, below the ceiling
--   slab X1 Y1 X2 Y2 THICKNESS [MATERIAL]            two corners; its upper side is the next floor
--   joists X1 Y1 X2 Y2 DEPTH                         two corners: a timber floor, which bears on the walls inside them
--   hole X1 Y1 X2 Y2                                 two corners, in slabs
--
-- name=WORD and bars=SHARE may follow.
local name = "rubble.read_plan"

-- By kind: the numbers that follow it.
local shapes = {
  storey = { "height" },
  storeys = { "first", "last" },
  wall = { "x1", "y1", "x2", "y2", "thickness" },
  window = { "x1", "y1", "x2", "y2", "bottom", "top" },
  door = { "x1", "y1", "x2", "y2", "top" },
  column = { "x", "y", "width_x", "width_y" },
  beam = { "x1", "y1", "x2", "y2", "thickness", "depth" },
  slab = { "x1", "y1", "x2", "y2", "thickness" },
  joists = { "x1", "y1", "x2", "y2", "thickness" },
  hole = { "x1", "y1", "x2", "y2" },
}
local kinds = "storey, storeys, wall, window, door, column, beam, slab, joists, hole"
local materials = { concrete = true, brick = true, block = true, timber = true }
local usual = { wall = "brick", joists = "timber" }

-- The two sides of `key=value`.
local function split(word)
  for n = 1, #word do
    if string.sub(word, n, n) == "=" then return string.sub(word, 1, n - 1), string.sub(word, n + 1) end
  end
end

return function(file)
  if type(file) ~= "string" then error(name .. " takes the name of a file", 2) end
  local text = rubble.read_table(file)
  local plan, lowest, highest = { heights = {}, parts = {} }, 0, 11
  for i, row in ipairs(text.rows) do
    local place = file .. ":" .. text.lines[i]
    local function fail(words) error(place .. ": " .. words, 3) end
    local kind = row[1]
    local shape = shapes[kind]
    if not shape then fail("unknown part `" .. tostring(kind) .. "`: expected one of " .. kinds) end
    local p = { name = place }
    for n, key in ipairs(shape) do
      p[key] = row[n + 1]
      if type(p[key]) ~= "number" then
        fail(kind .. ": expected " .. #shape .. " numbers (" .. table.concat(shape, ", ") .. "), found " ..
             (p[key] == nil and "only " .. (n - 1) or "`" .. tostring(p[key]) .. "` as " .. key))
      end
    end
    for n = #shape + 2, #row do
      local word = tostring(row[n])
      local key, value = split(word)
      if materials[word] then
        p.material = word
      elseif key == "name" then
        p.name = value
      elseif key == "bars" and tonumber(value) then
        p.bars = tonumber(value)
      elseif word ~= "" then
        fail(kind .. ": unknown word `" .. word .. "`: expected concrete, brick, block, timber, name=WORD or bars=SHARE")
      end
    end
    if kind == "storey" then
      plan.heights[#plan.heights + 1] = p.height
    elseif kind == "storeys" then
      if p.first < 0 or p.last > 11 or p.first > p.last then
        fail("storeys: expected two numbers from 0 to 11, the lower one first")
      end
      lowest, highest = p.first, p.last
    else
      local part = { kind = kind, name = p.name, lowest = math.tointeger(lowest) or lowest,
                     highest = math.tointeger(highest) or highest, material = p.material or usual[kind],
                     x1 = p.x1, y1 = p.y1, x2 = p.x2, y2 = p.y2, thickness = p.thickness,
                     bottom = p.bottom, top = p.top, depth = p.depth, bars = p.bars }
      if kind == "door" then part.kind = "window" end
      if kind == "column" then
        part.x1, part.x2 = p.x - p.width_x / 2, p.x + p.width_x / 2
        part.y1, part.y2 = p.y - p.width_y / 2, p.y + p.width_y / 2
      end
      plan.parts[#plan.parts + 1] = part
    end
  end
  if #plan.parts == 0 then error(file .. " draws nothing: it has none of " .. kinds, 2) end
  if #plan.heights == 0 then error(file .. " has no storey: write a line `storey HEIGHT` for each", 2) end
  return plan
end
