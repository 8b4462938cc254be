-- A path of your own: a function of time, asked once for every frame.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = rubble.trajectory.along(function(t)
    return { 5 * math.cos(t), 3 * math.sin(2 * t), 2 + 0.2 * math.sin(7 * t) }, { 0, 0, 0.3 }
  end, { duration = 1.5 }),
}
