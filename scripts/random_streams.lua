-- Numbers that follow from the seed: each named stream is a sequence of its own, so that drawing
-- more from one does not change another.
local shape, view = rubble.random("shape"), rubble.random("view")

local placed = {}
for i = 1, 5 do
  placed[i] = {
    asset = "pipe",
    position = { 1.5 * (i - 3), shape:normal(0, 0.3), 0.4 },
    rpy_deg = { 0, 0, shape:uniform(80, 100) },
  }
end

local from = 5 * rubble.vec(math.cos(view:uniform(0, 6.28)), math.sin(view:uniform(0, 6.28)), 0.5)
return rubble.mission {
  seed = 9,
  pile = {
    layers = 1, pieces_per_layer = 30, spawn_position = { 0, 0, 4 }, spawn_bounds = { 5, 3, 3 },
    placed = placed,
  },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = from, look_at = { 0, 0, 0.4 } } } },
}
