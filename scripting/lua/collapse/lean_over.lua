-- rubble.collapse.lean_over: whole storeys that turned about an edge of their base without breaking
-- apart. The rooms remain, tilted; each has the section length * storey_height.
--
-- The origin is on the edge that the frame turned about, at +X; the rooms run along Y.
local name = "rubble.collapse.lean_over"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 4, min = 0.5, max = 50, unit = "m", doc = "Length of a room, from wall to wall." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the rooms, along Y." },
    { "storey_height", 2.6, min = 0.3, max = 20, unit = "m", doc = "Height of a room, from floor to ceiling." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of floors and walls." },
    { "lean_deg", 30, min = 10, max = 90, unit = "degree", doc = "Angle by which the frame has turned." },
    { "storeys", 1, type = "integer", min = 1, max = 30, doc = "Number of rooms, one above another." },
    { "neighbour", true, doc = "The frame leans on the wall of a building beside it." },
  })
  local placed, t = {}, o.thickness
  -- A box of the upright frame, whose base edge is at x = 0, z = 0, turned with it.
  local function add(x0, x1, z0, z1, broken)
    local middle = rubble.rotate({ 0, o.lean_deg, 0 }, { (x0 + x1) / 2, 0, (z0 + z1) / 2 })
    placed[#placed + 1] = {
      box = { x1 - x0, o.width, z1 - z0 }, position = { middle.x, 0, middle.z },
      rpy_deg = { 0, o.lean_deg, 0 }, broken = broken, fixed = true,
    }
  end
  local outer = o.length + 2 * t
  add(-outer, 0, 0, t)
  for k = 0, o.storeys - 1 do
    local floor = t + k * (o.storey_height + t)
    add(-t, 0, floor, floor + o.storey_height)
    add(-outer, -outer + t, floor, floor + o.storey_height)
    add(-outer, 0, floor + o.storey_height, floor + o.storey_height + t, { "+y" })
  end
  local corner = rubble.rotate({ 0, o.lean_deg, 0 }, { 0, 0, t + o.storeys * (o.storey_height + t) })
  if o.neighbour then
    placed[#placed + 1] = rubble.wall {
      x0 = corner.x, x1 = corner.x + 1.5 * t, width = o.width, height = math.max(0.3, corner.z) + 0.5,
      broken = { "+z" },
    }
  end
  return rubble.assemble(o, placed)
end
