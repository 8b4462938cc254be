-- rubble.trajectory.spiral: a spiral around a vertical axis, with changing radius and height, and with the
-- view on its centre.
return function(given)
  local o = rubble.options("rubble.trajectory.spiral", given, rubble.trajectory_options {
    { "centre", { 0, 0, 0.5 }, min = -500, max = 500, unit = "m", doc = "The point that is looked at, on the axis." },
    { "radii", { 10, 4 }, type = "table", doc = "Radius of the first and the last circle; unit: m." },
    { "heights", { 5, 1.5 }, type = "table", doc = "Height above the centre of the first and the last circle; unit: m." },
    { "turns", 2, above = 0, max = 100, doc = "Number of turns." },
    { "start_deg", 180, min = -3600, max = 3600, unit = "degree", doc = "Angle of the start; 0 is at +X, 90 at +Y." },
    { "speed", 1, above = 0, max = 1000, unit = "m/s", doc = "Speed along the curve." },
  })
  for _, name in ipairs { "radii", "heights" } do
    local pair = o[name]
    if #pair ~= 2 or type(pair[1]) ~= "number" or type(pair[2]) ~= "number" then
      rubble.reject("rubble.trajectory.spiral", name, "two numbers {first, last}", pair)
      o[name] = { 10, 4 }
    end
  end
  local waypoints, steps, t = {}, math.max(2, math.ceil(120 * o.turns)), 0
  for i = 0, steps do
    local s = i / steps
    local angle = math.rad(o.start_deg + 360 * o.turns * s)
    local radius = o.radii[1] + (o.radii[2] - o.radii[1]) * s
    local position = rubble.vec(o.centre[1] + radius * math.cos(angle), o.centre[2] + radius * math.sin(angle),
                                o.centre[3] + o.heights[1] + (o.heights[2] - o.heights[1]) * s)
    local before = waypoints[i]
    if before then t = t + (position - before.position):norm() / o.speed end
    waypoints[i + 1] = { t = t, position = position, look_at = o.centre }
  end
  return rubble.fly(o, waypoints)
end
