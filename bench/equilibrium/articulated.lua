-- Standard work of the equilibrium bench: what falls from a house of concrete and timber, with
-- slabs that hang together on bent bars and doors that hang in their frames.
local weights = {
  hinged_slab = 2, door_on_frame = 1,
  brick = 2, worn_brick = 2, half_brick = 1, cinder_block = 1, broken_cinder_block = 1,
  chunk_1 = 1.5, chunk_2 = 1.5, chunk_3 = 1.5, chunk_4 = 1.5, chunk_5 = 1.5, chunk_6 = 1.5,
  slab_1 = 1, slab_2 = 1, slab_3 = 1, slab_4 = 1, slab_5 = 1,
  column = 0.3, beam = 0.3, pipe = 0.15, pipe_shard = 0.4, hollow_core = 0.25,
  rebar_straight = 0.4, rebar_bent = 0.4, rebar_hook = 0.4,
  timber_beam = 0.25, timber_beam_broken = 0.4, stud = 0.8, stud_broken = 1.2, stud_split = 1,
  plywood_sheet = 0.4, plywood_broken = 0.8, drywall_sheet = 0.4, drywall_torn = 1,
  drywall_shard = 1.2, window_frame = 0.6, window_frame_broken = 0.6, door = 0.4,
  door_broken = 0.6, chair = 0.7, chair_broken = 0.7, table = 0.4, table_broken = 0.4,
  sofa = 0.15, mattress = 0.3, refrigerator = 0.2,
}
local names = {}
for name in pairs(weights) do names[#names + 1] = name end
table.sort(names)
local mix = {}
for _, name in ipairs(names) do mix[#mix + 1] = { asset = name, weight = weights[name] } end

return rubble.mission {
  seed = 1,
  packs = { "concrete", "residential" },
  pile = {
    layers = 5,
    pieces_per_layer = 150,
    spawn_position = { 0, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
    mix = mix,
  },
}
