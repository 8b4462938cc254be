-- A vine robot grows to the deepest place that a ball of 35 cm reaches in the pile of first_pile.lua, 1.9 m under its
-- surface and 8 m from the mouth: `rubble voids` says where, and a camera on its tip sees the way.
local make_pile = rubble.include("lean_to_pile.lua")

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.vine {
      name = "vine", position = { -5.2, -0.65, 0.35 }, length = 8.4, link_length = 0.06, pressure = 20e3,
      control = rubble.robot.grow_along {
        path = { { -5.2, -0.65, 0.35 }, { -3, -0.7, 0.4 }, { 0.5, -0.7, 0.4 }, { 2.725, -0.775, 0.525 } },
        speed = 0.3,
      },
    },
  },
  robot_run = { duration = 30 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 30 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "vine", link = "tip", position = { 0.06, 0, 0 } } },
}
