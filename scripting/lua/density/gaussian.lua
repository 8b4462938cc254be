-- rubble.density.gaussian: a Gaussian distribution, densest in the middle.
return function(given)
  local o = rubble.options("rubble.density.gaussian", given, {
    { "deviation", 0.35, above = 0, max = 10, doc = "Standard deviation; 1 is the distance from the centre of the box to its edge." },
    { "x", 0, min = -1, max = 1, doc = "Position of the maximum along X; -1 and 1 are the edges of the box." },
    { "y", 0, min = -1, max = 1, doc = "Position of the maximum along Y; -1 and 1 are the edges of the box." },
  })
  return rubble.density.from(function(x, y)
    local a, b = (x - o.x) / o.deviation, (y - o.y) / o.deviation
    return math.exp(-math.min(600, (a * a + b * b) / 2))
  end)
end
