-- Free placement: pieces placed one by one, turned as a group, under debris.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.free {
    yaw_deg = 90,
    pieces = {
      { asset = "pipe", scale = 1.4, position = { 0, 0, 0.52 } },
      { asset = "box_culvert", position = { 1.9, 0, 0.76 } },
      rubble.slab { from = { -1, 0, 1.6 }, size = { 4, 2.4, 0.18 }, pitch_deg = -4, fixed = false },
    },
    debris = { layers = 1, pieces_per_layer = 40 },
  },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { width = 800, height = 800, fov_deg = 44 },
  trajectory = { waypoints = { { position = { -7, -4, 2.4 }, look_at = { 0, 0.5, 0.7 } } } },
}
