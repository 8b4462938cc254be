-- Checks bundled missions at a small size: `rubble suite scripts/ci/suite.lua`.
-- A suite of your own missions looks the same: docs/how_to/my_ci.md.
local small = { "pile.layers=1", "pile.pieces_per_layer=12", "camera.width=64", "camera.height=48",
                "trajectory.rate_hz=1" }

return suite {
  runs = {
    { name = "small", mission = "../small.lua",
      set = { "camera.width=64", "camera.height=48" },
      expect = { pieces = { 40, 40 }, pieces_lost = { 0, 0 }, frames = { 5, 5 },
                 pile_height_m = { 0.3, 1.5 }, depth_min_m = { 1, 4 },
                 depth_none_share = { 0, 0.5 } } },
    { name = "seeds", mission = "../small.lua", seeds = "1..3", pile_only = true,
      expect = { pile_height_m = { 0.3, 1.5 }, pile_radius_m = { 0.5, 4 },
                 simulated_s = { 0.5, 14 } } },
    { name = "placed", mission = "../placed.lua", set = small, pile_only = true,
      expect = { pieces_moving = { 0, 0 } } },
  },
}
