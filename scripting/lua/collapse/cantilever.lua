-- rubble.collapse.cantilever: slabs that are still held in a wall at one end; the other end hangs free.
-- Under the lowest slab is an open wedge: its height is `height` at the wall, and height - length *
-- sin(droop) at the tip.
--
-- The origin is at the foot of the wall's inner face; the slabs hang out along X.
local name = "rubble.collapse.cantilever"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 4, min = 0.5, max = 30, unit = "m", doc = "Length of a slab, from the wall to its tip." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the slabs and the wall." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of a slab." },
    { "height", 2.6, min = 0.2, max = 40, unit = "m", doc = "Height of the lower face of the lowest slab, at the wall." },
    { "droop_deg", 15, min = 0, max = 60, unit = "degree", doc = "Angle of the slabs below the horizontal." },
    { "storey_height", 3, min = 0.3, max = 20, unit = "m", doc = "Vertical distance between slabs." },
    { "storeys", 1, type = "integer", min = 1, max = 30, doc = "Number of slabs, one above another." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the wall." },
  })
  local angle = math.rad(o.droop_deg)
  if o.height - o.length * math.sin(angle) < 0.05 then
    rubble.reject(name, "droop_deg", "a slab that hangs clear of the floor", o.droop_deg)
    o.droop_deg, angle = 0, 0
  end
  local top = o.height + (o.storeys - 1) * o.storey_height + o.thickness + 0.5
  local placed = {
    rubble.wall { x0 = -o.wall_thickness, x1 = 0, width = o.width, height = top, broken = { "+z" } },
  }
  local held = 0.5 * o.wall_thickness * math.cos(angle)
  for k = 0, o.storeys - 1 do
    placed[#placed + 1] = rubble.slab {
      from = { -held * math.cos(angle), 0, o.height + k * o.storey_height + held * math.sin(angle) },
      size = { o.length + held, o.width, o.thickness }, pitch_deg = o.droop_deg,
      broken = { "+x" }, fixed = true, built_in = true,
    }
  end
  return rubble.assemble(o, placed)
end
