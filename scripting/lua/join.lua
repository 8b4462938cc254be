-- rubble.join(a, b, ...): one pile from several. Their pieces stand beside each other; what falls is
-- drawn from the first one's mix, in a box over all of them, as many pieces as they have together.
return function(...)
  local first, pile, low, high = nil, { placed = {}, layers = 0, pieces_per_layer = 0 }, nil, nil
  for i = 1, select("#", ...) do
    local part = select(i, ...)
    for _, item in ipairs(part.placed or {}) do pile.placed[#pile.placed + 1] = item end
    if (part.layers or 0) > 0 then
      first = first or part
      pile.layers = math.max(pile.layers, part.layers)
      pile.pieces_per_layer = pile.pieces_per_layer + part.pieces_per_layer
      local p, b = part.spawn_position, part.spawn_bounds
      low, high = low or { 1e9, 1e9, 1e9 }, high or { -1e9, -1e9, -1e9 }
      for k = 1, 3 do
        low[k], high[k] = math.min(low[k], p[k] - b[k] / 2), math.max(high[k], p[k] + b[k] / 2)
      end
    end
  end
  if first then
    pile.mix, pile.spawn_position, pile.spawn_bounds = first.mix, {}, {}
    for k = 1, 3 do
      pile.spawn_position[k] = (low[k] + high[k]) / 2
      pile.spawn_bounds[k] = high[k] - low[k]
    end
  end
  return pile
end
