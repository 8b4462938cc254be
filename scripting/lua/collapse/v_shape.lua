-- rubble.collapse.v_shape: a floor broken at mid-span. Its outer edges are held by the walls, and its
-- middle lies on the floor below. There are two voids of triangular section at the walls, each height *
-- sqrt((length / 2)^2 - height^2) / 2.
--
-- The origin is on the floor below the break; the walls stand at -X and +X.
local name = "rubble.collapse.v_shape"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 8, min = 1, max = 100, unit = "m", doc = "Length of the whole floor, both halves together." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the floor and the walls." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of the floor." },
    { "height", 1.8, min = 0.2, max = 40, unit = "m",
      doc = "Height of the edges on the walls; less than 0.45 times the length." },
    { "bearing", 0.08, min = 0.02, max = 2, unit = "m", doc = "Length of each half that lies on its wall." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the walls." },
    { "storeys", 1, type = "integer", min = 1, max = 30, doc = "Number of broken floors, one on another." },
  })
  if o.height >= 0.45 * o.length then
    rubble.reject(name, "height", "less than 0.45 times the length", o.height)
    o.height = 0.25 * o.length
  end
  local half = o.length / 2
  local clear = half - o.bearing
  local angle = math.asin(o.height / clear)
  local down, up = math.cos(angle), math.sin(angle)
  -- The halves lean towards each other, so that their upper edges meet first.
  local foot = o.storeys * (o.thickness + 0.004) * up + 0.005
  local wall = foot + clear * down
  local placed = {}
  for side = -1, 1, 2 do
    local inner, outer = side * wall, side * (wall + o.wall_thickness)
    placed[#placed + 1] = rubble.wall { x0 = math.min(inner, outer), x1 = math.max(inner, outer),
                                        width = o.width, height = o.height, broken = { "+z" } }
    for k = 0, o.storeys - 1 do
      local above = k * (o.thickness + 0.004)
      placed[#placed + 1] = rubble.slab {
        from = { side * (wall + o.bearing * down - above * up), 0,
                 o.height + o.bearing * up + above * down + 0.002 },
        size = { half, o.width, o.thickness }, pitch_deg = math.deg(angle),
        yaw_deg = side > 0 and 180 or 0, broken = { "+x" }, fixed = false,
      }
    end
  end
  return rubble.assemble(o, placed)
end
