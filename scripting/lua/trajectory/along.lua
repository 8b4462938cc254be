-- rubble.trajectory.along(f, options): a path from a function of time. f(t) returns the position and
-- the point that is looked at: `return {x, y, z}, {x, y, z}`; or a whole waypoint: `return { position =
-- ..., rpy_deg = ... }`. It is called once for every frame, while the mission loads.
local name = "rubble.trajectory.along"

return function(f, given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "duration", 4, min = 0, max = 86400, unit = "s", doc = "Time from the first frame to the last." },
  })
  if type(f) ~= "function" then error(name .. " takes a function of time first, not a " .. type(f), 2) end
  local waypoints, frames = {}, math.floor(o.duration * o.rate_hz + 1e-6)
  for i = 0, frames do
    local t = i / o.rate_hz
    local position, look_at = f(t)
    if type(position) ~= "table" then error(name .. ": f(" .. t .. ") gives no position {x, y, z}", 2) end
    local waypoint = position.position and position or { position = position, look_at = look_at }
    waypoint.t = t
    waypoints[i + 1] = waypoint
  end
  return rubble.fly(o, waypoints)
end
