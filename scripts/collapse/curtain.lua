-- A curtain wall: a panel of blocks that dropped straight down in front of its frame.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.curtain {
    length = 5, storeys = 1, debris = { layers = 0 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 42 },
  trajectory = { waypoints = { { position = { 7, -6, 2.6 }, look_at = { 0.6, 0, 0.9 } } } },
}
