-- rubble.collapse.curtain: a wall panel that broke in place and fell straight down. It forms a heap at
-- the foot of the frame that it hung on.
--
-- The origin is at the foot of the frame's outer face; the panel hangs in front of it, at +X.
return function(given)
  local o = rubble.options("rubble.collapse.curtain", given, rubble.structure_options {
    { "length", 5, min = 0.5, max = 50, unit = "m", doc = "Length of the panel, along Y." },
    { "storey_height", 2.6, min = 0.3, max = 20, unit = "m", doc = "Height of the panel in one storey." },
    { "storeys", 1, type = "integer", min = 1, max = 20, doc = "Number of storeys of the panel." },
    { "block", "cinder_block", doc = "Asset of the blocks of the panel, with its length along X." },
    { "block_size", { 0.39, 0.19, 0.19 }, above = 0, max = 5, unit = "m", doc = "Size of this asset." },
    { "missing", 0.1, min = 0, max = 0.9, doc = "Share of the blocks that are missing in the heap." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the frame that still stands." },
    { "stream", "curtain", doc = "Name of the random stream for the orientations of the blocks." },
  })
  local random = rubble.random(o.stream)
  local height = o.storeys * o.storey_height
  local placed = {
    rubble.wall { x0 = -o.wall_thickness, x1 = 0, width = o.length, height = height + 0.3, broken = { "+z" } },
  }
  local size, rows = o.block_size, 0
  local count = math.floor((1 - o.missing) * o.length * height / (size[1] * size[3]) + 0.5)
  -- The blocks hang in the air just outside the wall, in two sheets, each with room to be turned any
  -- way: that is how the panel comes apart.
  local pitch = math.sqrt(size[1] * size[1] + size[2] * size[2] + size[3] * size[3]) + 0.02
  local columns = math.max(1, math.floor(o.length / pitch))
  while count > 0 do
    for sheet = 0, 1 do
      for column = 1, math.min(columns, count) do
        placed[#placed + 1] = {
          asset = o.block,
          position = { (sheet + 0.55) * pitch, (column - (columns + 1) / 2) * o.length / columns,
                       (rows + 0.6) * pitch },
          rpy_deg = { random:uniform(-50, 50), random:uniform(-50, 50), random:uniform(0, 180) },
          fixed = false,
        }
      end
      count = count - math.min(columns, count)
    end
    rows = rows + 1
  end
  return rubble.assemble(o, placed)
end
