-- 10,000 frames of 640x480 on the way into the deepest void of a settled pile and out again, by a plain camera: how fast
-- pictures of a void are drawn and recorded (docs/development/performance.md).
--
--   rubble settle scripts/demonstration.lua --out out/ruin
--   rubble render out/ruin --mission bench/long_flight.lua --out out/long_flight

local void = rubble.find_void { radius = 0.2, by = "depth", approach = 2.5 }

return rubble.mission {
  packs = { "concrete", "residential" },
  light = { type = "sun", elevation_deg = 40, azimuth_deg = 230 },
  lamp = { on = true, intensity_cd = 15 },
  camera = { width = 640, height = 480, fov_deg = 80 },
  trajectory = {
    plan = "avoid", radius = 0.16, speed = 0.8, max_turn_rate_deg = 90, rate_hz = 205,
    waypoints = { { position = void.approach }, { position = void.deepest }, { position = void.approach } },
  },
  outputs = { rawlog = false, simplemap = false, bag = true, stl = false, preview = false },
}
