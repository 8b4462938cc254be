-- rubble.collapse.lean_to: one edge of a floor slab still rests on a wall, the other lies on the floor.
-- Under it is a void of triangular section, height * sqrt(length^2 - height^2) / 2.
--
-- The origin is at the foot of the wall's inner face; the slab goes down along X, the wall along Y.
local name = "rubble.collapse.lean_to"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 5, min = 0.5, max = 50, unit = "m", doc = "Length of the slab, from the wall to the floor." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the slab and the wall." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of the slab." },
    { "height", 2, min = 0.2, max = 40, unit = "m",
      doc = "Height of the edge on the wall; less than 0.9 times the length." },
    { "bearing", 0.08, min = 0.02, max = 2, unit = "m", doc = "Length of the slab that lies on the wall." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the wall." },
    { "storeys", 1, type = "integer", min = 1, max = 30, doc = "Number of slabs, one on another." },
  })
  if o.height >= 0.9 * o.length then
    rubble.reject(name, "height", "less than 0.9 times the length", o.height)
    o.height = 0.5 * o.length
  end
  local clear = o.length - o.bearing
  local angle = math.asin(o.height / clear)
  local down, up = math.cos(angle), math.sin(angle)
  local placed = {
    rubble.wall { x0 = -o.wall_thickness, x1 = 0, width = o.width, height = o.height, broken = { "+z" } },
  }
  for k = 0, o.storeys - 1 do
    -- Each further slab lies on the one below; on a steep one it has slid down to the floor.
    local above = k * (o.thickness + 0.004)
    local slid = up / down > 0.5 and above * down / up or 0
    placed[#placed + 1] = rubble.slab {
      from = { (slid - o.bearing) * down + above * up, 0, o.height + (o.bearing - slid) * up + above * down + 0.002 },
      size = { o.length, o.width, o.thickness }, pitch_deg = math.deg(angle),
      broken = { "+x" }, fixed = false,
    }
  end
  return rubble.assemble(o, placed)
end
