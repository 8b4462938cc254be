-- A vine robot grows into the lean-to of first_pile.lua, along the wall and over what lies there, with a camera and
-- a lamp at its tip. Its tube does not slide along: only the tip moves.
local placed = {
  { asset = "wall_stub", position = { -3.05, -1.32, 0.7 } },
  { asset = "wall_stub", position = { 0.0, -1.3, 0.7 } },
  { asset = "wall_stub", position = { 3.05, -1.28, 0.7 }, rpy_deg = { 3, 0, -1 } },
  { asset = "wall_stub", position = { 4.75, 0.3, 0.7 }, rpy_deg = { 0, 0, 90 } },
  { asset = "floor_slab", position = { -2.15, -0.12, 0.68 }, rpy_deg = { -27.3, 0, 1 } },
  { asset = "floor_slab", position = { 2.1, -0.08, 0.69 }, rpy_deg = { -26.8, 0.5, -1 } },
}
local lying = { "chunk_4", "brick", "cinder_block", "chunk_6", "half_brick", "worn_brick", "chunk_1" }
local random = rubble.random("room")
for i = 0, 10 do
  placed[#placed + 1] = {
    asset = lying[i % #lying + 1], fixed = false,
    position = { -2.6 + 0.6 * i, i % 2 == 0 and 0.25 or -0.95, 0.3 },
    rpy_deg = { random:uniform(-60, 60), random:uniform(-60, 60), random:uniform(0, 360) },
  }
end

return rubble.mission {
  seed = 1,
  pile = {
    layers = 1, pieces_per_layer = 60, spawn_position = { 1.2, 0.3, 6 }, spawn_bounds = { 7, 5, 8 },
    mix = { { asset = "chunk_2" }, { asset = "cinder_block" }, { asset = "brick", weight = 2 }, { asset = "slab_4" } },
    placed = placed,
  },
  robots = {
    rubble.robot.vine {
      name = "vine", position = { -5.2, -0.7, 0.4 }, length = 6, pressure = 15e3,
      control = rubble.robot.grow_along {
        path = { { -5.2, -0.7, 0.4 }, { -3.6, -0.75, 0.4 }, { -2, -0.8, 0.35 }, { 0.5, -0.8, 0.35 } },
        speed = 0.25,
      },
    },
  },
  robot_run = { duration = 24 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 20 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 1, ride = { robot = "vine", link = "tip", position = { 0.06, 0, 0 } } },
}
