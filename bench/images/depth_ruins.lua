-- A ruin and a flight from the widest entrance of its deepest void to the end of it, for depth_bench.
local structure = rubble.parameter("structure", "lean_to", {
  choices = { "lean_to", "cantilever", "v_shape", "a_frame", "pancake", "inclined", "lean_over", "culvert", "frame" },
  doc = "Collapse mode, or a building that comes down." })
local light = rubble.parameter("light_by", "day", { choices = { "day", "overcast", "lamp" }, doc = "What lights the void." })
local radius = rubble.parameter("radius", 0.15, { min = 0.05, max = 1, unit = "m", doc = "Radius of what flies." })

local debris = { layers = 2, pieces_per_layer = 80 }
local more = {
  lean_to = { length = 5, height = 2, storeys = 2 },
  cantilever = { length = 4, height = 2.2, droop_deg = 18 },
  v_shape = { length = 8, height = 1.8 },
  a_frame = { length = 9, height = 2.2 },
  pancake = { length = 7, width = 5, storeys = 3, gap = 0.6, tilt_deg = 3 },
  inclined = { length = 5, dip_deg = 20, spread_deg = 10, storeys = 3 },
  lean_over = { length = 3.5, storey_height = 2.4, lean_deg = 40, storeys = 1, width = 5 },
  culvert = { bore = 0.9, segments = 3, rows = 3, spacing = 0.25 },
}
-- A building whose ground storey gives way, onto its furniture; its floors break into pieces.
local furniture = { { asset = "table", per_bay = 1 }, { asset = "chair", per_bay = 2 }, { asset = "sofa", per_bay = 0.5 } }
local buildings = {
  frame = {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 4.5, span_y = 4.5, storey_height = 3, column = 0.3, beam_depth = 0.4,
    slab = 0.15, piece = 1.2, column_bars = 0.01, beam_bars = 0.008, slab_bars = 0.004, infill = "brick", openings = 0.4,
    furniture = furniture, cause = { weak_storey = 0, weakness = 0.1 },
  },
}
local function pile()
  if buildings[structure] then return rubble.building(buildings[structure]) end
  more[structure].debris = debris
  return rubble.collapse[structure](more[structure])
end

local lights = {
  day = { type = "sun", elevation_deg = 40, azimuth_deg = 30 },
  overcast = { type = "sun", elevation_deg = 40, azimuth_deg = 30, sky = "overcast" },
  lamp = { type = "sun", elevation_deg = -18 },
}
local void = rubble.find_void { radius = radius, by = "depth" }

return rubble.mission {
  seed = 1,
  packs = buildings[structure] and { "residential" } or nil,
  pile = pile(),
  settle = { final_time_limit = 60 },
  light = lights[light],
  lamp = { on = light == "lamp", intensity_cd = 60 },
  camera = { width = 128, height = 128, fov_deg = 90 },
  trajectory = {
    plan = "avoid", radius = 0.8 * radius, speed = 1,
    waypoints = { { position = void.entrance }, { position = void.deepest } },
  },
}
