-- A pancake: floors stacked on one another; columns and furniture keep gaps open.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.pancake {
    length = 7, width = 5, storeys = 4, gap = 0.55, tilt_deg = 3,
    debris = { layers = 1, pieces_per_layer = 90, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 42 },
  trajectory = { waypoints = { { position = { 2.5, -12, 2.4 }, look_at = { 0, 0, 1.5 } } } },
}
