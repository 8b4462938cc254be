-- rubble.density.line: densest on a line.
return function(given)
  local name = "rubble.density.line"
  local o = rubble.options(name, given, {
    { "from", { -0.8, 0, 0 }, min = -1, max = 1, doc = "Start {x, y, 0}; -1 and 1 are the edges of the box." },
    { "to", { 0.8, 0, 0 }, min = -1, max = 1, doc = "End {x, y, 0}." },
    { "deviation", 0.08, above = 0, max = 2, doc = "Standard deviation across the line; 1 is the distance from the centre of the box to its edge." },
  })
  local a, way = rubble.vec(o.from[1], o.from[2], 0), rubble.vec(o.to[1] - o.from[1], o.to[2] - o.from[2], 0)
  local square = math.max(way:dot(way), 1e-12)
  return rubble.density.from(function(x, y)
    local p = rubble.vec(x, y, 0) - a
    local s = math.max(0, math.min(1, p:dot(way) / square))
    local off = p - way * s
    return math.exp(-math.min(600, off:dot(off) / (2 * o.deviation * o.deviation)))
  end, { columns = 80, rows = 80 })
end
