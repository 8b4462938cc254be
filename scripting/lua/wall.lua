-- rubble.wall { x0 =, x1 =, width =, height =, ... }: a wall from x0 to x1, `width` long about y, from `bottom` up to
-- `height`, as an entry of `pile.placed`. Its sides are parallel to the axes; rubble.slab makes one that is turned.
local name = "rubble.wall"

return function(given)
  local o = rubble.options(name, given, {
    { "x0", nil, type = "number", min = -1000, max = 1000, unit = "m", doc = "Lower end along X; must be given." },
    { "x1", nil, type = "number", min = -1000, max = 1000, unit = "m", doc = "Upper end along X; must be given." },
    { "width", nil, type = "number", min = 0.02, max = 100, unit = "m", doc = "Length along Y; must be given." },
    { "height", nil, type = "number", min = -1000, max = 1000, unit = "m", doc = "Z of its upper side; must be given." },
    { "y", 0, min = -1000, max = 1000, unit = "m", doc = "Y of its middle." },
    { "bottom", 0, min = -1000, max = 1000, unit = "m", doc = "Z of its lower side." },
    { "material", nil, type = "string", doc = "As `pile.placed[].material`." },
    { "broken", {}, type = "strings", doc = "As `pile.placed[].broken`." },
    { "fixed", true, doc = "As `pile.placed[].fixed`." },
  })
  for _, key in ipairs { "x0", "x1", "width", "height" } do
    if given == nil or (type(given) == "table" and given[key] == nil) then rubble.reject(name, key, "a number", nil) end
  end
  if not (o.x0 and o.x1 and o.width and o.height) then return { box = { 1, 1, 1 }, position = { 0, 0, 0 } } end
  if o.x1 <= o.x0 then rubble.reject(name, "x1", "more than `x0`", o.x1) end
  if o.height <= o.bottom then rubble.reject(name, "height", "more than `bottom`", o.height) end
  return {
    box = { o.x1 - o.x0, o.width, o.height - o.bottom },
    position = { (o.x0 + o.x1) / 2, o.y, (o.bottom + o.height) / 2 },
    material = o.material, broken = o.broken, fixed = o.fixed,
  }
end
