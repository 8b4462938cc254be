-- Nothing is left standing: pieces dropped in layers from a box, the control case.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.heap {
    layers = 4, pieces_per_layer = 80, length = 5, width = 5, height = 5,
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 48 },
  trajectory = { waypoints = { { position = { -9, 0, 2.2 }, look_at = { 0, 0, 0.6 } } } },
}
