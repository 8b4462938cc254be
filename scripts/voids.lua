-- The voids of the settled pile as figures in the manifest, for suites and a batch's table: how much
-- room there is, and how much of it a robot of this radius can reach.
return rubble.mission {
  seed = 4,
  pile = rubble.collapse.lean_to { height = 1.8, debris = { layers = 1, pieces_per_layer = 40 } },
  voids = { on = true, voxel = 0.05, radius = 0.2 },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = { 2, -7, 2 }, look_at = { 1, 0, 0.6 } } } },
}
