-- rubble.terrain.image(file, options): a picture or an elevation model of the script's folder as heights. Its
-- upper edge is at +Y. Of grey levels black is 0 and white is `amplitude`. Heights in metres (GeoTIFF, TIFF of real
-- numbers, ESRI ASCII grid) keep their scale; the lowest is at z = 0.
local name = "rubble.terrain.image"

-- The lowest and the highest height, and how many points have none.
local function range_of(values)
  local low, high, missing = math.huge, -math.huge, 0
  for _, v in ipairs(values) do
    if v ~= v then
      missing = missing + 1
    else
      low, high = math.min(low, v), math.max(high, v)
    end
  end
  return low, high, missing
end

local function smoothed(last, columns, rows)
  local heights = {}
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
  return heights
end

local function number(v) return string.format("%.10g", v) end

return function(file, given)
  local o = rubble.options(name, given, {
    { "length", nil, type = "number", min = 1, max = 100000, unit = "m",
      doc = "Length along X; the width follows from the shape of the picture. Not given: that of the file's scale, else 40 m." },
    { "amplitude", nil, type = "number", above = 0, max = 500, unit = "m",
      doc = "Height of white pixels, 2 m if not given. Of a file with heights in metres: their range is stretched to this." },
    { "smooth", nil, type = "integer", min = 0, max = 20,
      doc = "How often each height is averaged with its neighbours. Not given: once for 256 grey levels, which give steps; else 0." },
    { "samples", 256, type = "integer", min = 2, max = 900,
      doc = "Points a side that are kept at most; files with more are averaged over square blocks, which is printed." },
    { "missing", nil, type = "number", min = -10000, max = 10000, unit = "m",
      doc = "Height, in the file's own scale, of points where the file has none." },
    { "x", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along X." },
    { "y", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along Y." },
    { "friction", 0.8, min = 0, max = 2, doc = "Coulomb coefficient against concrete." },
    { "look", "ground", doc = "Look of the surface, such as ground or concrete_cast." },
  })
  if type(file) ~= "string" then error(name .. " takes the name of a picture or elevation model first", 2) end
  local image = rubble.read_image(file, o.samples)
  local columns, rows = image.columns, image.rows
  if columns < 2 or rows < 2 then error(name .. ": the picture is narrower than two pixels", 2) end
  if image.block > 1 then
    print(file .. ": averaged over blocks of " .. image.block .. " by " .. image.block .. " points to " .. columns ..
          " by " .. rows .. (image.cut_columns + image.cut_rows > 0 and ", without " .. image.cut_columns ..
          " columns and " .. image.cut_rows .. " rows at the edges, which fill no block" or "") ..
          "; `samples` keeps more, up to 900 a side")
  end
  if image.colour then print(file .. ": a colour picture; its brightness is taken as height") end
  local low, high, missing = range_of(image.values)
  if missing > 0 and not o.missing then
    error(name .. ": " .. missing .. " of " .. columns * rows .. (image.block > 1 and " averaged" or "") .. " points of " .. file ..
          " have no height: give `missing`, a height for them, or fill them and save a PNG or TIFF", 2)
  end
  if missing > 0 then low, high = math.min(low, o.missing), math.max(high, o.missing) end
  if image.degrees and not o.length then
    error(name .. ": " .. file .. " has points every " .. number(image.spacing) ..
          " degrees: give `length`, or project it to metres (gdalwarp -t_srs EPSG:326..)", 2)
  end
  local lift, scale = 0, o.amplitude or 2
  if image.metric then
    lift, scale = -low, o.amplitude and high > low and o.amplitude / (high - low) or 1
    print(file .. ": heights from " .. number(low) .. " to " .. number(high) .. " m; the lowest is at z = 0" ..
          (image.east and not image.degrees and ", the centre at east " ..
           number(image.east + image.spacing * columns / 2) .. ", north " .. number(image.north + image.spacing * rows / 2) or ""))
  end
  local heights = {}
  for row = rows, 1, -1 do
    for column = 1, columns do
      local v = image.values[(row - 1) * columns + column]
      if v ~= v then v = o.missing end
      heights[#heights + 1] = scale * (v + lift)
    end
  end
  local smooth = o.smooth or (image.levels == 256 and 1 or 0)
  for _ = 1, smooth do heights = smoothed(heights, columns, rows) end
  local spacing = not o.length and image.spacing or (o.length or 40) / (columns - 1)
  return { columns = columns, rows = rows, spacing = spacing,
    position = { o.x, o.y, 0 }, heights = heights, friction = o.friction, look = o.look }
end
