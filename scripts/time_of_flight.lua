-- A time-of-flight sensor: flying pixels at edges, ranges that wrap, and echoes of smoke in front of the
-- surface.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  air = { fog_density = 0.1 },
  camera = { width = 320, height = 240, fov_deg = 60 },
  depth_sensor = { type = "time_of_flight", min_range = 0.2, max_range = 7.4, modulation_mhz = 20 },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 0.5, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
