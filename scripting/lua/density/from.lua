-- rubble.density.from(f, options): a density from a function. f(x, y) is the relative frequency of
-- pieces at a place of the spawn box; x and y are from -1 to 1, the edges of the box.
return function(f, given)
  local o = rubble.options("rubble.density.from", given, {
    { "columns", 48, type = "integer", min = 1, max = 256, doc = "Number of columns of the grid on which f is sampled." },
    { "rows", 48, type = "integer", min = 1, max = 256, doc = "Number of rows of this grid." },
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
