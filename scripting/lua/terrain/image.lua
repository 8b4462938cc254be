-- rubble.terrain.image(file, options): a PNG file of the script's folder as heights: black is 0, white is
-- `amplitude`; its upper edge is at +Y.
return function(file, given)
  local name = "rubble.terrain.image"
  local o = rubble.options(name, given, {
    { "length", 40, min = 1, max = 1000, unit = "m", doc = "Length along X; the width follows from the shape of the picture." },
    { "amplitude", 2, above = 0, max = 500, unit = "m", doc = "Height of white pixels." },
    { "smooth", 1, type = "integer", min = 0, max = 20, doc = "How often each height is averaged with its neighbours; without it, 256 grey levels give steps." },
    { "x", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along X." },
    { "y", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along Y." },
    { "friction", 0.8, min = 0, max = 2, doc = "Coulomb coefficient against concrete." },
    { "look", "ground", doc = "Look of the surface, such as ground or concrete_cast." },
  })
  if type(file) ~= "string" then error(name .. " takes the name of a PNG file first", 2) end
  local image = rubble.read_image(file)
  local columns, rows = image.columns, image.rows
  if columns < 2 or rows < 2 then error(name .. ": the picture is narrower than two pixels", 2) end
  local heights = {}
  for row = rows, 1, -1 do
    for column = 1, columns do
      heights[#heights + 1] = o.amplitude * image.values[(row - 1) * columns + column]
    end
  end
  for _ = 1, o.smooth do
    local last = heights
    heights = {}
    for row = 0, rows - 1 do
      for column = 1, columns do
        local sum, count = 0, 0
        for r = math.max(0, row - 1), math.min(rows - 1, row + 1) do
          for c = math.max(1, column - 1), math.min(columns, column + 1) do
            sum = sum + last[r * columns + c]
            count = count + 1
          end
        end
        heights[#heights + 1] = sum / count
      end
    end
  end
  return { columns = columns, rows = rows, spacing = o.length / (columns - 1),
    position = { o.x, o.y, 0 }, heights = heights, friction = o.friction, look = o.look }
end
