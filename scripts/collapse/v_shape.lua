-- A V: the floor broke at mid-span, its outer edges are still held by the walls.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.v_shape {
    length = 8, height = 1.8,
    debris = { layers = 2, pieces_per_layer = 90, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 42 },
  trajectory = { waypoints = { { position = { 0, -14.5, 1.8 }, look_at = { 0, 0, 1.2 } } } },
}
