-- A lean-over: two storeys turned about an edge of their base; the rooms survive, turned.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.lean_over {
    length = 3.5, storey_height = 2.4, lean_deg = 40, storeys = 2, width = 5,
    debris = { layers = 1, pieces_per_layer = 100, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 40 },
  trajectory = { waypoints = { { position = { 0.5, -16, 3 }, look_at = { 0.5, 0, 2.6 } } } },
}
