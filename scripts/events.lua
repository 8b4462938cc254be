-- An event camera beside the frames: changes of brightness, each with its own time.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 160, height = 120 },
  event_camera = { on = true, threshold_up = 0.25, threshold_down = 0.25 },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 1.6 }, rpy_deg = { 0, 15, -20 } },
      { t = 2, position = { -3.4, -0.6, 1.6 }, rpy_deg = { 0, 15, 60 } },
    },
  },
}
