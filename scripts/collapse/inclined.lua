-- Inclined floors: a fan of slabs that share a dip; the voids are wedges.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.inclined {
    length = 5, dip_deg = 20, spread_deg = 10, storeys = 3,
    debris = { layers = 1, pieces_per_layer = 80, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 36 },
  trajectory = { waypoints = { { position = { 2.2, -12, 1.9 }, look_at = { 2.2, 0, 1.5 } } } },
}
