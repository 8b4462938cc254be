-- rubble.collapse.a_frame: the floors on both sides of an interior wall still rest on it, and their
-- outer edges lie on the ground floor. There are two voids of triangular section beside the wall, each
-- height * sqrt((length / 2)^2 - height^2) / 2.
--
-- The origin is at the foot of the middle of the wall; the slabs go down along -X and +X.
local name = "rubble.collapse.a_frame"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 9, min = 1, max = 100, unit = "m", doc = "Length of both slabs together." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the slabs and the wall." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of the slabs." },
    { "height", 2, min = 0.2, max = 40, unit = "m",
      doc = "Height of the slab edges on the wall; less than 0.45 times the length." },
    { "bearing", 0.08, min = 0.02, max = 2, unit = "m", doc = "Length of each slab that lies on the wall." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the wall; more than twice the bearing." },
    { "storeys", 1, type = "integer", min = 1, max = 30, doc = "Number of slabs on each side, one on another." },
  })
  if o.height >= 0.45 * o.length then
    rubble.reject(name, "height", "less than 0.45 times the length", o.height)
    o.height = 0.25 * o.length
  end
  if o.wall_thickness < 2 * o.bearing + 0.01 then
    rubble.reject(name, "wall_thickness", "more than twice the bearing", o.wall_thickness)
    o.wall_thickness = 2 * o.bearing + 0.02
  end
  local half = o.length / 2
  local angle = math.asin(o.height / (half - o.bearing))
  local down, up = math.cos(angle), math.sin(angle)
  local edge = o.wall_thickness / 2
  local placed = {
    rubble.wall { x0 = -edge, x1 = edge, width = o.width, height = o.height, broken = { "+z" } },
  }
  for side = -1, 1, 2 do
    for k = 0, o.storeys - 1 do
      local above = k * (o.thickness + 0.004)
      local slid = up / down > 0.5 and above * down / up or 0
      placed[#placed + 1] = rubble.slab {
        from = { side * (edge + (slid - o.bearing) * down + above * up), 0,
                 o.height + (o.bearing - slid) * up + above * down + 0.002 },
        size = { half, o.width, o.thickness }, pitch_deg = math.deg(angle),
        yaw_deg = side < 0 and 180 or 0, broken = { "+x" }, fixed = false,
      }
    end
  end
  return rubble.assemble(o, placed)
end
