-- rubble.robot.grow_along: a controller that grows a vine along a path, by pure pursuit in space: new links
-- follow the arc through the point of the path that is `lookahead` ahead of the tip.
local name = "rubble.robot.grow_along"

local function is_finite(v) return type(v) == "number" and math.abs(v) < math.huge end

return function(given)
  local o = rubble.options(name, given, {
    { "path", {}, type = "table", doc = "Points {x, y, z} in the world, starting at the base; unit: m." },
    { "speed", 0.2, min = 0.001, max = 1, unit = "m/s", doc = "Speed of growth." },
    { "lookahead", 0.5, min = 0.05, max = 10, unit = "m", doc = "Lookahead distance; shorter: sharper bends." },
    { "curvature", 2, min = 0.01, max = 5, unit = "1/m", doc = "Largest curvature of new links." },
    { "stuck_after", 2, min = 0.1, max = 3600, unit = "s",
      doc = "Growth stops after this time without progress." },
    { "back", false, doc = "Retracts at the end of the path, and after growth has stopped." },
  })
  if #o.path < 2 then
    rubble.reject(name, "path", "two points {x, y, z} or more", o.path)
    return function() return {} end
  end
  for i, p in ipairs(o.path) do
    local x, y, z
    if type(p) == "table" then x, y, z = p[1] or p.x, p[2] or p.y, p[3] or p.z end
    if not (is_finite(x) and is_finite(y) and is_finite(z)) then
      error(name .. ".path[" .. i .. "] is not a point {x, y, z}", 2)
    end
    o.path[i] = { x, y, z }
  end

  local function minus(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
  local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end

  -- The path from its start: leg i begins at length[i].
  local length = { 0 }
  for i = 2, #o.path do
    local leg = minus(o.path[i], o.path[i - 1])
    length[i] = length[i - 1] + math.sqrt(dot(leg, leg))
    if length[i] == length[i - 1] then error(name .. ".path[" .. i .. "] repeats the point before it", 2) end
  end

  local function point_at(s)
    for i = 2, #o.path do
      if s <= length[i] or i == #o.path then
        local share = (s - length[i - 1]) / (length[i] - length[i - 1])
        local a, leg = o.path[i - 1], minus(o.path[i], o.path[i - 1])
        return { a[1] + leg[1] * share, a[2] + leg[2] * share, a[3] + leg[3] * share }
      end
    end
  end

  -- How far along the path the tip is: the nearest point, not before the last one.
  local function progress(tip, from)
    local best, nearest = from, math.huge
    for i = 2, #o.path do
      if length[i] >= from and length[i - 1] <= from + 2 * o.lookahead then
        local leg, to = minus(o.path[i], o.path[i - 1]), minus(tip, o.path[i - 1])
        local along = length[i - 1] + dot(to, leg) / (length[i] - length[i - 1])
        local s = math.max(from, math.min(length[i], along))
        local away = minus(tip, point_at(s))
        if dot(away, away) < nearest then best, nearest = s, dot(away, away) end
      end
    end
    return best
  end

  local along, grown, since, stuck = 0, -1, 0, false
  return function(sense)
    if not sense.vine then error(name .. ": this robot does not grow", 2) end
    if sense.vine.length > grown + 0.001 then grown, since = sense.vine.length, sense.t end
    stuck = stuck or sense.t - since > o.stuck_after
    local tip = sense.truth.tip
    along = progress(tip.position, along)
    if stuck or along >= length[#length] then
      stuck = true
      return { growth = o.back and -o.speed or 0 }
    end
    -- The arc through the target: its curvature is twice the distance to the side over the distance squared.
    local to = minus(point_at(along + o.lookahead), tip.position)
    local left, up = 2 * dot(to, tip.left) / dot(to, to), 2 * dot(to, tip.up) / dot(to, to)
    local most = math.sqrt(left * left + up * up) / o.curvature
    if most > 1 then left, up = left / most, up / most end
    return { growth = o.speed, curvature = left, curvature_up = up }
  end
end
