-- rubble.fly(o, waypoints, interpolation): a `trajectory` through waypoints from the options of a
-- path.
return function(o, waypoints, interpolation)
  return {
    rate_hz = o.rate_hz, plan = o.plan, radius = o.radius, interpolation = interpolation or "spline",
    max_speed = o.max_speed, max_acceleration = o.max_acceleration,
    max_turn_rate_deg = o.max_turn_rate_deg, max_jerk = o.max_jerk, smoothing = o.smoothing,
    rest_at_ends = o.rest_at_ends, waypoints = waypoints,
  }
end
