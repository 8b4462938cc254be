-- An A-frame: floors on both sides still rest on an interior wall.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.a_frame {
    length = 9, height = 2.2,
    debris = { layers = 2, pieces_per_layer = 90, margin = -0.5 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 44 },
  trajectory = { waypoints = { { position = { 0, -13, 1.8 }, look_at = { 0, 0, 1.2 } } } },
}
