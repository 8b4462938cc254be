-- A training ground: rows of concrete pipes, covered by debris.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.culvert {
    bore = 0.9, segments = 3, rows = 3, spacing = 0.25, yaw_deg = 90,
    debris = { layers = 2, pieces_per_layer = 110, margin = -0.2 },
  },
  light = { rpy_deg = { 0, 48, 150 } },
  camera = { width = 800, height = 800, fov_deg = 44 },
  trajectory = { waypoints = { { position = { 0, -8.5, 1.3 }, look_at = { 0, 0, 0.6 } } } },
}
