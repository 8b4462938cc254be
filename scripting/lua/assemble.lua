-- rubble.assemble(o, placed): a `pile` from the options of a structure and its pieces, which are
-- written as in `pile.placed` but in the structure's own frame: they are moved to o.position, turned
-- by o.yaw_deg and covered with o.debris.
local small_pieces = {
  { asset = "chunk_1", weight = 3 }, { asset = "chunk_2", weight = 3 },
  { asset = "chunk_3", weight = 3 }, { asset = "chunk_4", weight = 4 },
  { asset = "chunk_5", weight = 3 }, { asset = "chunk_6", weight = 4 },
  { asset = "slab_2" }, { asset = "slab_3" }, { asset = "slab_5", weight = 1.5 },
  { asset = "cinder_block", weight = 3 }, { asset = "half_cinder_block", weight = 2 },
  { asset = "broken_cinder_block", weight = 3 },
  { asset = "brick", weight = 5 }, { asset = "worn_brick", weight = 4 },
  { asset = "half_brick", weight = 4 },
  { asset = "rebar_straight", weight = 0.5 }, { asset = "rebar_bent", weight = 0.5 },
}
local room_of_a_piece = 0.7  -- of the air that a layer is drawn in; m3

-- {x, y, z} of a vector in either way of writing it; nil: it is no vector that rubble.rotate takes.
local function listed(v)
  if type(v) ~= "table" then return nil end
  local list = { v[1] or v.x, v[2] or v.y, v[3] or v.z }
  for k = 1, 3 do
    if type(list[k]) ~= "number" or not (math.abs(list[k]) <= 1e6) then return nil end
  end
  return list
end

local function can_be_moved(item)
  return type(item) == "table" and listed(item.position) and (item.rpy_deg == nil or listed(item.rpy_deg))
end

local function moved(o, item)
  local copy = {}
  for name, value in pairs(item) do copy[name] = value end
  local p, rpy = rubble.rotate({ 0, 0, o.yaw_deg }, item.position), listed(item.rpy_deg or { 0, 0, 0 })
  copy.position = { o.position[1] + p.x, o.position[2] + p.y, o.position[3] + p.z }
  copy.rpy_deg = { rpy[1], rpy[2], math.fmod(rpy[3] + o.yaw_deg, 360) }
  return copy
end

-- Extends the rectangle by the eight corners of a box; an asset counts as one metre each way.
local function include(rectangle, item)
  local size = item.box and listed(item.box)
  local reach = 2 * (type(item.scale) == "number" and item.scale or 1)
  if not size then size = { reach, reach, reach } end
  for i = 0, 7 do
    local corner = { size[1] * (i % 2 - 0.5), size[2] * (i // 2 % 2 - 0.5), size[3] * (i // 4 - 0.5) }
    local p = rubble.rotate(item.rpy_deg, corner)
    local x, y = item.position[1] + p.x, item.position[2] + p.y
    rectangle.x0, rectangle.x1 = math.min(rectangle.x0, x), math.max(rectangle.x1, x)
    rectangle.y0, rectangle.y1 = math.min(rectangle.y0, y), math.max(rectangle.y1, y)
  end
end

return function(o, placed)
  if type(placed) ~= "table" then error("rubble.assemble takes a list of pieces second, not a " .. type(placed), 2) end
  local pile = { placed = {}, layers = 0 }
  local r = { x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9 }
  for i, item in ipairs(placed) do
    if can_be_moved(item) then
      pile.placed[i] = moved(o, item)
      include(r, pile.placed[i])
    else
      pile.placed[i] = item  -- the mission's reader says what is wrong with it
    end
  end
  local debris = o.debris
  if debris.layers == 0 or debris.pieces_per_layer == 0 or #placed == 0 then return pile end
  local length = math.max(1, r.x1 - r.x0 + 2 * debris.margin)
  local width = math.max(1, r.y1 - r.y0 + 2 * debris.margin)
  local height = math.min(100, math.max(3, debris.pieces_per_layer * room_of_a_piece / (length * width)))
  pile.layers, pile.pieces_per_layer = debris.layers, debris.pieces_per_layer
  pile.mix = #debris.mix > 0 and debris.mix or small_pieces
  -- Where the box is lower than the structure, a layer starts above it all the same.
  pile.spawn_position = { (r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2, 1 + height / 2 }
  pile.spawn_bounds = { length, width, height }
  return pile
end
