-- rubble.robot.follow: a controller that drives a robot with tracks or wheels along a path, by pure
-- pursuit (Coulter 1992, "Implementation of the pure pursuit path tracking algorithm"). It steers along
-- the arc through the point of the path that is `lookahead` ahead of the robot.
local name = "rubble.robot.follow"

local function is_finite(v) return type(v) == "number" and math.abs(v) < math.huge end

return function(given)
  local o = rubble.options(name, given, {
    { "path", {}, type = "table",
      doc = "Points {x, y}, in the world, or with `odometry` relative to the start of the robot; unit: m." },
    { "speed", 0.3, min = 0.01, max = 5, unit = "m/s", doc = "Speed along the path." },
    { "lookahead", 0.4, min = 0.05, max = 10, unit = "m", doc = "Lookahead distance. A shorter one cuts corners less and oscillates more." },
    { "turn", 1, min = 0.05, max = 10, unit = "rad/s", doc = "Largest angular velocity." },
    { "by", "truth", type = "choice", choices = { "truth", "odometry" }, doc = "Localization by ground truth or by odometry." },
    { "flippers", {}, type = "table", doc = "Crawler: four flipper angles, constant during the run; unit: rad." },
  })
  if #o.path < 2 then
    rubble.reject(name, "path", "two points {x, y} or more", o.path)
    return function() return {} end
  end
  for i, p in ipairs(o.path) do
    local x, y
    if type(p) == "table" then x, y = p[1] or p.x, p[2] or p.y end
    if not (is_finite(x) and is_finite(y)) then error(name .. ".path[" .. i .. "] is not a point {x, y}", 2) end
    o.path[i] = { x, y }
  end

  -- The path from its start: leg i begins at length[i].
  local length = { 0 }
  for i = 2, #o.path do
    local dx, dy = o.path[i][1] - o.path[i - 1][1], o.path[i][2] - o.path[i - 1][2]
    length[i] = length[i - 1] + math.sqrt(dx * dx + dy * dy)
    if length[i] == length[i - 1] then error(name .. ".path[" .. i .. "] repeats the point before it", 2) end
  end

  -- How far along the path the robot is: the nearest point, not before the last one and not beyond the
  -- next corner but one.
  local function progress(x, y, from)
    local best, nearest = from, math.huge
    for i = 2, #o.path do
      if length[i] >= from and length[i - 1] <= from + 2 * o.lookahead then
        local ax, ay = o.path[i - 1][1], o.path[i - 1][2]
        local ux = (o.path[i][1] - ax) / (length[i] - length[i - 1])
        local uy = (o.path[i][2] - ay) / (length[i] - length[i - 1])
        local along = (x - ax) * ux + (y - ay) * uy
        local s = math.max(from, math.min(length[i], length[i - 1] + along))
        local px, py = ax + ux * (s - length[i - 1]), ay + uy * (s - length[i - 1])
        local d = (x - px) * (x - px) + (y - py) * (y - py)
        if d < nearest then best, nearest = s, d end
      end
    end
    return best
  end

  local function point_at(s)
    for i = 2, #o.path do
      if s <= length[i] or i == #o.path then
        local share = (s - length[i - 1]) / (length[i] - length[i - 1])
        local a, b = o.path[i - 1], o.path[i]
        return a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share
      end
    end
  end

  local along = 0
  return function(sense)
    local x, y, yaw
    if o.by == "truth" then
      x, y, yaw = sense.truth.position[1], sense.truth.position[2], sense.truth.yaw
    else
      if not sense.odometry then error(name .. ": this robot has no odometry", 2) end
      x, y, yaw = sense.odometry.x, sense.odometry.y, sense.odometry.yaw
    end
    along = progress(x, y, along)
    local command = { linear = 0, angular = 0 }
    if #o.flippers > 0 then command.flippers = o.flippers end
    local c, s = math.cos(yaw), math.sin(yaw)
    -- Beyond its end the path goes straight on, so that the last point is passed.
    local tx, ty = point_at(along + o.lookahead)
    local forward, left = (tx - x) * c + (ty - y) * s, (ty - y) * c - (tx - x) * s
    if along >= length[#length] then return command end
    local far = forward * forward + left * left
    if forward <= 0 then
      command.angular = left >= 0 and o.turn or -o.turn
      return command
    end
    local angular = 2 * left / far * o.speed
    command.angular = math.max(-o.turn, math.min(o.turn, angular))
    -- What cannot be turned in time is driven slower.
    command.linear = math.abs(angular) > o.turn and o.speed * o.turn / math.abs(angular) or o.speed
    return command
  end
end
