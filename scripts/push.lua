-- A pole camera, pushed straight into a culvert.
return rubble.mission {
  seed = 2,
  pile = rubble.collapse.culvert { rows = 1, segments = 3, debris = { layers = 1, pieces_per_layer = 30 } },
  camera = { width = 320, height = 240, fov_deg = 100 },
  trajectory = rubble.trajectory.push {
    from = { -3, 0, 0.48 }, to = { 1.5, 0, 0.48 }, speed = 1.5, plan = "refuse", radius = 0.1,
  },
}
