-- Cantilevers: two floors still held in the wall at one end, the other end hanging free.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.cantilever {
    length = 4, height = 2.4, droop_deg = 18, storeys = 2, storey_height = 2.4,
    debris = { layers = 1, pieces_per_layer = 80, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 36 },
  trajectory = { waypoints = { { position = { 1.8, -15, 3 }, look_at = { 1.8, 0, 2.4 } } } },
}
