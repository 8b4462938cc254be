-- rubble.trajectory_options(list): a path's own parameters, and those that every trajectory has;
-- rubble.fly makes the trajectory of them.
return function(list)
  local common = {
    { "rate_hz", 30, min = 0.001, max = 1000, unit = "Hz", doc = "Frames per second." },
    { "plan", "ghost", choices = { "ghost", "refuse", "avoid" },
      doc = "As `trajectory.plan`: fly through pieces, stop at the first contact, or fly around." },
    { "radius", nil, type = "number", min = 0.005, max = 10, unit = "m", doc = "As `trajectory.radius`: of the camera's body." },
    { "max_speed", nil, type = "number", above = 0, max = 1000, unit = "m/s", doc = "As `trajectory.max_speed`." },
    { "max_acceleration", nil, type = "number", above = 0, max = 10000, unit = "m/s2",
      doc = "As `trajectory.max_acceleration`." },
    { "max_turn_rate_deg", nil, type = "number", above = 0, max = 36000, unit = "degree/s",
      doc = "As `trajectory.max_turn_rate_deg`." },
    { "max_jerk", nil, type = "number", above = 0, max = 1000000, unit = "m/s3", doc = "As `trajectory.max_jerk`." },
    { "smoothing", nil, type = "number", min = 0, max = 2, unit = "s", doc = "As `trajectory.smoothing`." },
    { "rest_at_ends", false, doc = "As `trajectory.rest_at_ends`." },
  }
  local all = {}
  for i, entry in ipairs(list) do all[i] = entry end
  for _, entry in ipairs(common) do all[#all + 1] = entry end
  return all
end
