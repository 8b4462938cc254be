-- The demonstration of the page on structure from motion: an earthquake brings down a furnished house, and a camera
-- goes around the ruin, or into its deepest void and out again, by a way that the planner finds.
--   rubble run scripts/demonstration.lua --out out/outside
--   rubble render out/outside --mission scripts/demonstration.lua --set flight=inside --set lamp.on=true --out out/inside
local flight = rubble.parameter("flight", "outside", {
  choices = { "outside", "inside", "track" }, doc = "Around the ruin, into it, or along track.txt beside this script.",
})
local bricks = rubble.parameter("bricks", 2800, { type = "integer", min = 0, max = 20000, doc = "Loose pieces that fall last." })
local lidar = rubble.parameter("lidar", false, { doc = "An Ouster OS0 on the camera." })
local radius = rubble.parameter("radius", 0.2, { min = 0.05, max = 1, unit = "m", doc = "Of the robot that goes in." })

-- An open ground storey under two storeys with brick walls: the shaking breaks its columns.
local house = rubble.building {
  storeys = 3, bays_x = 3, bays_y = 2, span_x = 5, span_y = 5, column = 0.3, piece = 1.2, partitions = "brick",
  furniture = {
    { asset = "sofa", per_bay = 0.5 }, { asset = "mattress", per_bay = 0.7 }, { asset = "table", per_bay = 1 },
    { asset = "chair", per_bay = 3 }, { asset = "refrigerator", per_bay = 0.3 },
  },
  cause = { shake = 6, weak_storey = 0, weakness = 0.3 },
}
-- What masonry leaves: bricks, their halves and small lumps of concrete.
house.layers, house.pieces_per_layer = bricks > 0 and 4 or 0, math.ceil(bricks / 4)
house.spawn_position, house.spawn_bounds = { 0, 0, 11 }, { 18, 13, 3 }
house.mix = {
  { asset = "brick", weight = 5 }, { asset = "worn_brick", weight = 4 }, { asset = "half_brick", weight = 6 },
  { asset = "chunk_4", weight = 2 }, { asset = "chunk_6", weight = 2 }, { asset = "broken_cinder_block", weight = 1 },
}

local void = rubble.find_void { radius = radius, by = "depth", approach = 2.5 }
local trajectory
if flight == "outside" then
  trajectory = rubble.trajectory.orbit { centre = { 0, 0, 1 }, radius_m = 15, height = 3.5, turns = 0.3 }
  trajectory.duration = 12.5
  trajectory.rate_hz = 10
elseif flight == "track" then
  trajectory = rubble.trajectory.file { path = "track.txt", rate_hz = 5 }
else
  -- In to the deepest place, where it turns back, and out again, with a fifth of its radius to spare.
  trajectory = {
    plan = "avoid", radius = 0.8 * radius, speed = 0.8, max_turn_rate_deg = 90, rate_hz = 5,
    waypoints = { { position = void.approach }, { position = void.deepest }, { position = void.approach } },
  }
end

return rubble.mission {
  seed = 1,
  packs = { "concrete", "residential" },
  pile = house,
  fines = { amount = 40000 },
  settle = { final_time_limit = 60 },
  light = { type = "sun", elevation_deg = 40, azimuth_deg = 230 },
  lamp = { on = false, intensity_cd = 15 },
  -- A small industrial camera behind a wide lens: its exposure follows the light late, and it stores JPEG.
  camera = {
    width = 1024, height = 1024, fov_deg = 80,
    shutter = { motion_blur = true, most_samples = 9 },
    exposure = { mode = "automatic", f_number = 2, longest_time = 0.02, highest_iso = 1600, time_constant = 0.3 },
    optics = { point_spread = 0.5 },
    sensor = { vignette = 1, prnu = 0.01, jpeg_quality = 90 },
  },
  lidars = lidar and { top = { model = "os0", position = { 0, 0, 0.08 } } } or {},
  trajectory = trajectory,
}
