-- rubble.trajectory.grow: a growing robot. It moves only forward along its optical axis, and turns
-- towards one target after another, by at most `turn_deg_per_m` per metre.
local name = "rubble.trajectory.grow"

local function unit(v) return v * (1 / v:norm()) end

-- `heading` turned towards the direction `wanted` by at most `most` radians.
local function turned(heading, wanted, most)
  local cosine = math.max(-1, math.min(1, heading:dot(wanted)))
  local angle = math.acos(cosine)
  if angle <= most then return wanted end
  local side = wanted - heading * cosine
  if side:norm() < 1e-9 then side = rubble.vec(-heading.y, heading.x, 0) end  -- straight behind
  if side:norm() < 1e-9 then side = rubble.vec(1, 0, 0) end
  return unit(heading * math.cos(most) + unit(side) * math.sin(most))
end

return function(given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "from", { -6, 0, 0.5 }, min = -1000, max = 1000, unit = "m", doc = "Start of the path." },
    { "towards", { { 0, 0, 0.5 } }, type = "table", doc = "Targets, one after another: {{x, y, z}, ...}." },
    { "pitch_deg", nil, type = "number", min = -90, max = 90, unit = "degree",
      doc = "Pitch at the start, positive: down; without pitch and yaw: towards the first point." },
    { "yaw_deg", nil, type = "number", min = -360, max = 360, unit = "degree", doc = "Yaw at the start." },
    { "turn_deg_per_m", 40, above = 0, max = 3600, unit = "degree/m", doc = "Largest change of direction per metre." },
    { "reach", 0.15, above = 0, max = 10, unit = "m", doc = "A point counts as reached within this distance." },
    { "speed", 0.2, above = 0, max = 1000, unit = "m/s", doc = "Speed of growth." },
    { "length", 50, above = 0, max = 500, unit = "m", doc = "Largest length." },
  })
  local p, targets = rubble.vec(o.from[1], o.from[2], o.from[3]), {}
  for i, target in ipairs(o.towards) do
    local ok = type(target) == "table"
    local v = ok and { target[1] or target.x, target[2] or target.y, target[3] or target.z } or {}
    if type(v[1]) ~= "number" or type(v[2]) ~= "number" or type(v[3]) ~= "number" then
      rubble.reject(name, "towards", "a list of points {{x, y, z}, ...}", target)
    else
      targets[#targets + 1] = rubble.vec(v[1], v[2], v[3])
    end
  end
  if #targets == 0 then return rubble.fly(o, { { position = p } }) end
  local heading = (targets[1] - p):norm() > 1e-9 and unit(targets[1] - p) or rubble.vec(1, 0, 0)
  if o.pitch_deg or o.yaw_deg then
    heading = rubble.rotate({ 0, o.pitch_deg or 0, o.yaw_deg or 0 }, { 1, 0, 0 })
  end
  local step, grown, next_target = 0.02, 0, 1
  local waypoints = { { t = 0, position = p, look_at = p + heading } }
  while next_target <= #targets do
    local way = targets[next_target] - p
    if way:norm() <= o.reach then
      next_target = next_target + 1
    elseif grown >= o.length then
      rubble.reject(name, "towards", "points that it can reach within its length and bend", targets[next_target])
      break
    else
      heading = turned(heading, unit(way), math.rad(o.turn_deg_per_m) * step)
      p, grown = p + heading * step, grown + step
      if math.floor(grown / 0.1 + 1e-6) >= #waypoints then
        waypoints[#waypoints + 1] = { t = grown / o.speed, position = p, look_at = p + heading }
      end
    end
  end
  -- Legs so short are as good as a curve, and bend no more than was asked for.
  return rubble.fly(o, waypoints, "linear")
end
