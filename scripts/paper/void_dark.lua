-- The published demonstration, in the void without a light of its own: 88 frames by what daylight comes in.
local demonstration_pile = rubble.include("demonstration_pile.lua")

return rubble.mission {
  seed = 1,
  pile = demonstration_pile(),
  light = { intensity = 80, rpy_deg = { 0, 45, 40 } },
  lamp = { on = false },
  camera = { width = 1024, height = 1024, fov_deg = 80 },
  trajectory = {
    plan = "avoid", radius = 0.15, duration = 87 / 30,
    waypoints = {
      { position = { -1.4, -5.2, 0.63 } },
      { position = { -1.4, -2.2, 0.63 } },
      { position = { -1.2, 2.2, 0.6 } },
    },
  },
}
