-- A vine robot grows into the lean-to of first_pile.lua, turns round in it and grows out again.
local make_pile = rubble.include("lean_to_pile.lua")

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.vine {
      name = "vine", position = { -5.2, -0.95, 0.3 }, length = 7, pressure = 15e3,
      control = rubble.robot.grow_along {
        path = { { -5.2, -0.95, 0.3 }, { -3.9, -0.95, 0.3 }, { -3.35, -0.8, 0.3 }, { -3.15, -0.4, 0.3 },
                 { -3.35, 0, 0.3 }, { -3.9, 0.15, 0.3 }, { -5.4, 0.15, 0.3 } },
        speed = 0.3, lookahead = 0.35, curvature = 2.5,
      },
    },
  },
  robot_run = { duration = 24 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 30 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "vine", link = "tip", position = { 0.06, 0, 0 } } },
}
