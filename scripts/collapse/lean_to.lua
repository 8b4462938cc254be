-- A lean-to: one edge of each slab still rests on the wall, the other lies on the floor.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.lean_to {
    length = 5, height = 2, storeys = 2,
    debris = { layers = 2, pieces_per_layer = 80, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 36 },
  trajectory = { waypoints = { { position = { 2.2, -11, 1.6 }, look_at = { 2.2, 0, 1.3 } } } },
}
