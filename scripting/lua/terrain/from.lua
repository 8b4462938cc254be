-- rubble.terrain.from(f, options): terrain from a function. f(x, y) is the height in metres at a
-- position of the world, sampled on a grid. It must be at least 0, the height of the ground.
return function(f, given)
  local name = "rubble.terrain.from"
  local o = rubble.options(name, given, {
    { "length", 40, min = 1, max = 1000, unit = "m", doc = "Length along X." },
    { "width", 40, min = 1, max = 1000, unit = "m", doc = "Width along Y." },
    { "spacing", 0.5, min = 0.05, max = 50, unit = "m", doc = "Edge length of the square cells of the grid." },
    { "x", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along X." },
    { "y", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along Y." },
    { "friction", 0.8, min = 0, max = 2, doc = "Coulomb coefficient against concrete." },
    { "look", "ground", doc = "Look of the surface, such as ground or concrete_cast." },
  })
  if type(f) ~= "function" then
    error(name .. " takes a function of x and y first, not a " .. type(f), 2)
  end
  local columns = math.floor(o.length / o.spacing + 0.5) + 1
  local rows = math.floor(o.width / o.spacing + 0.5) + 1
  if columns < 2 or rows < 2 or columns > 512 or rows > 512 then
    rubble.reject(name, "spacing", "one that gives 2 to 512 corners each way", o.spacing)
    columns, rows = 2, 2
  end
  local heights = {}
  for row = 0, rows - 1 do
    for column = 0, columns - 1 do
      local h = f(o.x + (column - (columns - 1) / 2) * o.spacing, o.y + (row - (rows - 1) / 2) * o.spacing)
      if type(h) ~= "number" or h < 0 or h ~= h or h > 1000 then
        error(name .. ": f gives " .. tostring(h) .. ", not a height from 0 to 1000 m", 2)
      end
      heights[#heights + 1] = h
    end
  end
  return { columns = columns, rows = rows, spacing = o.spacing, position = { o.x, o.y, 0 },
    heights = heights, friction = o.friction, look = o.look }
end
