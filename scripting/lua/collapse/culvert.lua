-- rubble.collapse.culvert: a training ground as rescue services build it: concrete pipes or box
-- culverts in rows, covered by debris. The voids are the bores.
--
-- The origin is on the ground in the centre; the bores run along X.
local kinds = {
  pipe = { asset = "pipe", bore = 0.60, outer = 0.72, length = 1.20 },
  box = { asset = "box_culvert", bore = 1.20, outer = 1.50, length = 2.00 },
}

return function(given)
  local o = rubble.options("rubble.collapse.culvert", given, rubble.structure_options {
    { "kind", "pipe", choices = { "pipe", "box" }, doc = "Round pipes, or box culverts." },
    { "bore", 0.8, min = 0.2, max = 5, unit = "m", doc = "Inner diameter of a pipe, or inner edge length of a box." },
    { "segments", 4, type = "integer", min = 1, max = 100, doc = "Number of pieces in a row, end to end." },
    { "rows", 2, type = "integer", min = 1, max = 50, doc = "Number of rows, side by side." },
    { "spacing", 0.5, min = 0, max = 20, unit = "m", doc = "Gap between two rows." },
    { "joint", 0.01, min = 0.005, max = 1, unit = "m", doc = "Gap between two pieces of a row." },
    { "fixed", true, doc = "false: falling debris can push the pieces apart." },
  })
  local kind = kinds[o.kind]
  local scale = o.bore / kind.bore
  local pitch, outer, placed = kind.length * scale + o.joint, kind.outer * scale, {}
  for row = 1, o.rows do
    for i = 1, o.segments do
      placed[#placed + 1] = {
        asset = kind.asset, scale = scale, fixed = o.fixed,
        position = { (i - (o.segments + 1) / 2) * pitch,
                     (row - (o.rows + 1) / 2) * (outer + o.spacing), outer / 2 + 0.005 },
      }
    end
  end
  return rubble.assemble(o, placed)
end
