-- rubble.collapse.pancake: floors stacked on one another, with gaps held open by contents between them.
-- The voids are flat; the height of the stack is storeys * (thickness + gap).
--
-- The origin is on the ground below the centre of the stack.
local name = "rubble.collapse.pancake"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 8, min = 1, max = 100, unit = "m", doc = "Length of a floor, along X." },
    { "width", 6, min = 1, max = 100, unit = "m", doc = "Width of a floor, along Y." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of a floor." },
    { "gap", 0.6, min = 0.05, max = 5, unit = "m", doc = "Gap between two floors: the height of the contents." },
    { "tilt_deg", 2, min = 0, max = 5, unit = "degree",
      doc = "Slope of the floors, alternating in direction, because the contents have different heights." },
    { "shift", 0.05, min = 0, max = 0.1, doc = "Horizontal shift between floors, as a share of the length." },
    { "supports", 2, type = "integer", min = 2, max = 20, doc = "Number of rows of contents along X, and along Y." },
    { "storeys", 3, type = "integer", min = 1, max = 30, doc = "Number of floors." },
    { "stream", "pancake", doc = "Name of the random stream for shifts and contents." },
  })
  local random, placed = rubble.random(o.stream), {}
  local slope = math.tan(math.rad(o.tilt_deg))
  local reach = 0.36 * o.length
  -- What two floors that slope against each other come together by at their ends; the lowest lies over level ground.
  local closing = o.storeys > 1 and slope * (1 + o.shift) * o.length or slope * o.length / 2
  if closing > o.gap then
    rubble.reject(name, "tilt_deg", "a slope that leaves the lower side open", o.tilt_deg)
    slope = 0
  end
  local below, bottom, x, y = 0, 0, 0, 0  -- of the floor that is next: slope and height in its middle
  for k = 1, o.storeys do
    local tilt = (k % 2 == 1 and 1 or -1) * slope
    local x_before = x
    if k > 1 then
      x = o.shift * o.length * random:uniform(-0.5, 0.5)
      y = o.shift * o.length * random:uniform(-0.5, 0.5)
    end
    for i = 1, o.supports do
      for j = 1, o.supports do
        local side = 0.3 * random:uniform(0.8, 1.2)
        local px = reach * (2 * (i - 1) / (o.supports - 1) - 1)
        local py = 0.36 * o.width * (2 * (j - 1) / (o.supports - 1) - 1) + random:uniform(-0.1, 0.1)
        local floor = bottom + below * (px - x_before)
        -- Up to the floor above its lower edge: the two floors are not parallel.
        local height = bottom + o.gap + tilt * (px - x) - floor - side / 2 * math.abs(tilt - below)
        placed[#placed + 1] = {
          box = { side, side, height }, position = { px, py, floor + height / 2 + 0.002 },
          rpy_deg = { 0, -math.deg(math.atan(below)), 0 }, broken = { "+x", "-x" }, fixed = false,
        }
      end
    end
    local angle = -math.deg(math.atan(tilt))
    local middle = rubble.rotate({ 0, angle, 0 }, { 0, 0, o.thickness / 2 })
    placed[#placed + 1] = {
      box = { o.length, o.width, o.thickness }, rpy_deg = { 0, angle, 0 },
      position = { x + middle.x, y, bottom + o.gap + middle.z + 0.006 },
      broken = { "+x", "-y" }, fixed = false,
    }
    bottom, below = bottom + o.gap + o.thickness + 0.006, tilt
  end
  return rubble.assemble(o, placed)
end
