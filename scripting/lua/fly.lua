-- rubble.fly(o, waypoints, interpolation): a `trajectory` through waypoints from the options of a
-- path.

-- A way around pieces has a length that is not known yet: its waypoints have speeds instead of times. It never stands still.
local function with_speeds(waypoints)
  local moving, last, t = {}, nil, 0
  for _, w in ipairs(waypoints) do
    local p = rubble.vec(w.position[1] or w.position.x, w.position[2] or w.position.y, w.position[3] or w.position.z)
    local length = last and (p - last):norm() or 0
    if not last or length > 1e-9 then
      moving[#moving + 1] = { position = p, rpy_deg = w.rpy_deg, look_at = w.look_at, speed = last and length / (w.t - t) }
      last, t = p, w.t or 0
    end
  end
  return moving
end

return function(o, waypoints, interpolation)
  -- "ghost" is the default: left out, a radius that it does not read is named.
  return {
    rate_hz = o.rate_hz, plan = o.plan ~= "ghost" and o.plan or nil, radius = o.radius, interpolation = interpolation or "spline",
    max_speed = o.max_speed, max_acceleration = o.max_acceleration,
    max_turn_rate_deg = o.max_turn_rate_deg, max_jerk = o.max_jerk, smoothing = o.smoothing,
    rest_at_ends = o.rest_at_ends, waypoints = o.plan == "avoid" and with_speeds(waypoints) or waypoints,
  }
end
