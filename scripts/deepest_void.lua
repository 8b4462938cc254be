-- A flight into the deepest void, for any seed: the path around obstacles is planned after the pile has
-- settled. flight.json holds the path.
local void = rubble.find_void { radius = 0.22, by = "depth" }

return rubble.mission {
  seed = 3,
  pile = rubble.collapse.lean_to { height = 1.8, debris = { layers = 2, pieces_per_layer = 60 } },
  camera = { width = 320, height = 240, fov_deg = 100 },
  trajectory = {
    plan = "avoid", radius = 0.2, speed = 1.5,
    waypoints = { { position = { 2, -7, 2 } }, { position = void.approach }, { position = void.deepest } },
  },
}
