-- The depth of a structured-light sensor, beside the exact depth: steps, noise that grows with
-- the square of the distance, shadows of the projector, lost edges, and smoke in the way.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  air = { fog_density = 0.15 },
  camera = { width = 320, height = 240, fov_deg = 60 },
  depth_sensor = { type = "structured_light", min_range = 0.4, max_range = 6 },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 0.5, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
