-- rubble.trajectory.orbit: a circle around a point, with the view on this point.
return function(given)
  local o = rubble.options("rubble.trajectory.orbit", given, rubble.trajectory_options {
    { "centre", { 0, 0, 0.5 }, min = -500, max = 500, unit = "m", doc = "Centre of the circle, and the point that is looked at." },
    { "radius_m", 9, min = 0.05, max = 500, unit = "m", doc = "Radius of the circle." },
    { "height", 3, min = -500, max = 500, unit = "m", doc = "Height above the centre." },
    { "turns", 1, min = -100, max = 100, doc = "Number of turns; below 0: clockwise, seen from above." },
    { "start_deg", 180, min = -3600, max = 3600, unit = "degree", doc = "Angle of the start; 0 is at +X, 90 at +Y." },
    { "speed", 1, above = 0, max = 1000, unit = "m/s", doc = "Speed along the circle." },
  })
  local waypoints, steps = {}, math.max(2, math.ceil(120 * math.abs(o.turns)))
  local length = 2 * math.pi * o.radius_m * math.abs(o.turns)
  for i = 0, steps do
    local angle = math.rad(o.start_deg + 360 * o.turns * i / steps)
    waypoints[i + 1] = {
      t = length / o.speed * i / steps,
      position = { o.centre[1] + o.radius_m * math.cos(angle), o.centre[2] + o.radius_m * math.sin(angle),
                   o.centre[3] + o.height },
      look_at = o.centre,
    }
    if length == 0 then break end
  end
  return rubble.fly(o, waypoints)
end
