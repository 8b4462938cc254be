-- Debris on a hillside: a slope with a step and a hollow in it. What falls on it slides, rolls and
-- gathers in the hollow; camera, exports and maps of voids know the hill.
local function height(x, y)
  local slope = 3 + 0.16 * x
  local r2 = (x + 1) ^ 2 + y ^ 2
  local hollow = 1.4 / (1 + (r2 / 6) ^ 2)
  local step = x > 5 and 0.6 or 0
  local bumps = 0.12 * math.sin(1.7 * x) * math.cos(1.3 * y)
  return math.max(0.2, slope + step - hollow + bumps)
end

return rubble.mission {
  seed = 4,
  pile = {
    layers = 3, pieces_per_layer = 90,
    spawn_bounds = { 6, 6, 5 }, spawn_position = { -0.5, 0, 7 },
    terrain = rubble.terrain.from(height, { length = 30, width = 30, spacing = 0.3 }),
  },
  light = { type = "sun", elevation_deg = 38, azimuth_deg = 120 },
  camera = { width = 960, height = 640, fov_deg = 70 },
  lamp = { on = false },
  trajectory = { rate_hz = 2, waypoints = {
    { t = 0, position = { -9, -7, 6.5 }, look_at = { -0.5, 0, 2.2 } },
    { t = 2, position = { -10, 3, 5 }, look_at = { -0.5, 0, 2.2 } },
  } },
  outputs = { meshes = { "glb" } },
}
