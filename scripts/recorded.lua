-- A recorded path, flown again at half its speed, at most 1 m/s. hand_held.txt is in TUM format.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = rubble.trajectory.file { path = "hand_held.txt", slower = 2, max_speed = 1 },
}
