-- rubble.slab { from =, size =, pitch_deg =, yaw_deg =, ... }: a box as an entry of `pile.placed`,
-- given by the middle of the lower edge at its -X end, from which it runs along its own X axis. A
-- positive pitch goes down. `from` and `size` give its position and size; an entry { box = ... } takes the others.
local name = "rubble.slab"

return function(given)
  local o = rubble.options(name, given, {
    { "from", nil, type = "vector", min = -1000, max = 1000, unit = "m",
      doc = "Middle of the lower edge at its -X end; must be given." },
    { "size", nil, type = "vector", min = 0.02, max = 100, unit = "m", doc = "Full edge lengths; must be given." },
    { "pitch_deg", 0, min = -360, max = 360, unit = "degree", doc = "Pitch; positive: it goes down along X." },
    { "yaw_deg", 0, min = -360, max = 360, unit = "degree", doc = "Yaw." },
    { "material", nil, type = "string", doc = "As `pile.placed[].material`." },
    { "broken", {}, type = "strings", doc = "As `pile.placed[].broken`." },
    { "fixed", true, doc = "As `pile.placed[].fixed`." },
    { "built_in", nil, type = "boolean", doc = "As `pile.placed[].built_in`." },
  })
  for _, key in ipairs { "from", "size" } do
    if given == nil or (type(given) == "table" and given[key] == nil) then
      rubble.reject(name, key, "three numbers {x, y, z}", nil)
    end
  end
  if not (o.from and o.size) then return { box = { 1, 1, 1 }, position = { 0, 0, 0 } } end
  local rpy_deg = { 0, o.pitch_deg, o.yaw_deg }
  local middle = rubble.rotate(rpy_deg, { o.size[1] / 2, 0, o.size[3] / 2 })
  return {
    box = o.size, rpy_deg = rpy_deg, position = { o.from[1] + middle.x, o.from[2] + middle.y, o.from[3] + middle.z },
    material = o.material, broken = o.broken, fixed = o.fixed, built_in = o.built_in or nil,
  }
end
