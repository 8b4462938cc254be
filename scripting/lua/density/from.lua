-- rubble.density.from(f, options): a density of your own. f(x, y) is how often pieces are drawn at a
-- place of the spawn box, relative to elsewhere; x and y go from -1 to 1, its edges.
return function(f, given)
  local o = rubble.options("rubble.density.from", given, {
    { "columns", 48, type = "integer", min = 1, max = 256, doc = "Of the grid that f is sampled on." },
    { "rows", 48, type = "integer", min = 1, max = 256, doc = "Of the grid." },
  })
  if type(f) ~= "function" then
    error("rubble.density.from takes a function of x and y first, not a " .. type(f), 2)
  end
  local weights = {}
  for row = 1, o.rows do
    for column = 1, o.columns do
      local w = f((2 * column - 1) / o.columns - 1, (2 * row - 1) / o.rows - 1)
      if type(w) ~= "number" or w < 0 or w ~= w or w == math.huge then
        error("rubble.density.from: f gives " .. tostring(w) .. ", not a number of at least 0", 2)
      end
      weights[#weights + 1] = w
    end
  end
  return { columns = o.columns, rows = o.rows, weights = weights }
end
