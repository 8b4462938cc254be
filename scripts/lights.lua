-- A floodlight from above instead of the sun, and no lamp on the camera.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { type = "spot", intensity = 4, position = { -3, 0, 6 }, rpy_deg = { 0, 65, 0 }, cone_deg = 50 },
  lamp = { on = false },
  camera = { width = 320, height = 240 },
}
