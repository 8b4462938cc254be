-- rubble.density.ring: uniform between two radii, zero elsewhere. If the box is longer than wide, the
-- ring is an ellipse.
return function(given)
  local name = "rubble.density.ring"
  local o = rubble.options(name, given, {
    { "inner", 0.5, min = 0, max = 1.4, doc = "Inner radius; 1 is the distance from the centre of the box to its edge." },
    { "outer", 0.95, above = 0, max = 1.5, doc = "Outer radius." },
  })
  if o.outer < o.inner + 0.05 then
    rubble.reject(name, "outer", "at least 0.05 more than the inner radius", o.outer)
    o.inner = 0
    o.outer = 1
  end
  return rubble.density.from(function(x, y)
    local r = math.sqrt(x * x + y * y)
    return r >= o.inner and r <= o.outer and 1 or 0
  end, { columns = 96, rows = 96 })
end
