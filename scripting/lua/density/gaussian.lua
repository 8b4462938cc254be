-- rubble.density.gaussian: densest in the middle; falls off to either side.
return function(given)
  local o = rubble.options("rubble.density.gaussian", given, {
    { "deviation", 0.35, above = 0, max = 10, doc = "Standard deviation; 1 is from the middle of the box to its edge." },
    { "x", 0, min = -1, max = 1, doc = "Where the middle is: -1 and 1 are the edges of the box." },
    { "y", 0, min = -1, max = 1, doc = "Where the middle is along Y: -1 and 1 are the edges of the box." },
  })
  return rubble.density.from(function(x, y)
    local a, b = (x - o.x) / o.deviation, (y - o.y) / o.deviation
    return math.exp(-math.min(600, (a * a + b * b) / 2))
  end)
end
