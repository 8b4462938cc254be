-- A house from a plan, scripts/ruins/house.txt: the wall beside its entrance is gone.
return rubble.mission {
  seed = 3,
  packs = { "residential" },
  pile = rubble.building {
    plan = rubble.read_plan("house.txt"), piece = 0.9,
    cause = { removed = { { storey = 0, part = "street" } } },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -3, -9, 6 }, look_at = { 5, 4, 2 } } } },
  outputs = { frames = true },
}
