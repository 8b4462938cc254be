-- A growing robot: forward along its optical axis, with bends of limited sharpness.
return rubble.mission {
  seed = 3,
  pile = rubble.collapse.lean_to { debris = { layers = 1, pieces_per_layer = 40 } },
  camera = { width = 320, height = 240, fov_deg = 100 },
  trajectory = rubble.trajectory.grow {
    from = { 2, -6, 0.8 }, yaw_deg = 90, turn_deg_per_m = 45, speed = 1,
    towards = { { 1.2, -3, 0.6 }, { 1.4, 0, 0.5 }, { 1, 2.2, 0.5 } },
  },
}
