-- People in the voids of a collapsed building: the piles of `rubble bench search` (docs/explanation/search.md).
--   rubble bench search scripts/search.lua --baseline frontier --seeds 1..10
--   rubble bench search scripts/search.lua --agent "python3 examples/search/agent.py" --set victims.difficulty=hard
local random = rubble.random("search")
return rubble.mission {
  seed = 1,
  victims = { count = 4, difficulty = "medium" },
  pile = rubble.join(
    rubble.collapse.pancake {
      length = random:uniform(6, 8), width = random:uniform(5, 7), gap = random:uniform(0.7, 1), storeys = 2,
      debris = { layers = 1, pieces_per_layer = 30 },
    },
    rubble.collapse.lean_to {
      position = { random:uniform(5, 6), random:uniform(-1, 1), 0 }, yaw_deg = random:uniform(-30, 30),
      length = 5, height = random:uniform(1.6, 2.2), debris = { layers = 1, pieces_per_layer = 30 },
    }),
  camera = { width = 320, height = 240, fov_deg = 90 },
  lamp = { on = true },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -6, -4, 3 }, look_at = { 2, 0, 0 } },
    { t = 1, position = { -6, -3, 3 }, look_at = { 2, 0, 0 } } } },
}
