-- rubble.wall { x0 =, x1 =, width =, height =, y =, bottom = }: a fixed wall from x0 to x1, `width`
-- long about y (default 0), from `bottom` (default 0) up to `height`, as an entry of `pile.placed`.
return function(given)
  local bottom = given.bottom or 0
  return {
    box = { given.x1 - given.x0, given.width, given.height - bottom },
    position = { (given.x0 + given.x1) / 2, given.y or 0, (bottom + given.height) / 2 },
    broken = given.broken, fixed = true,
  }
end
