-- rubble.trajectory.push: straight ahead along the optical axis, like a pole camera.
local name = "rubble.trajectory.push"

return function(given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "from", { -6, 0, 0.5 }, min = -1000, max = 1000, unit = "m", doc = "Start of the path." },
    { "to", { 0, 0, 0.5 }, min = -1000, max = 1000, unit = "m", doc = "End of the path." },
    { "roll_deg", 0, min = -360, max = 360, unit = "degree", doc = "Roll of the camera at the end; it rolls uniformly." },
    { "speed", 0.3, above = 0, max = 1000, unit = "m/s", doc = "Speed along the line." },
  })
  local from, to = rubble.vec(o.from[1], o.from[2], o.from[3]), rubble.vec(o.to[1], o.to[2], o.to[3])
  local way = to - from
  if way:norm() < 1e-6 then
    rubble.reject(name, "to", "a point away from `from`", o.to)
    return rubble.fly(o, { { position = from } })
  end
  local ahead = to + way * (1 / way:norm())
  return rubble.fly(o, {
    { t = 0, position = from, look_at = ahead },
    { t = way:norm() / o.speed, position = to, look_at = ahead, rpy_deg = { o.roll_deg, 0, 0 } },
  }, "linear")
end
