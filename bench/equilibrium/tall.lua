-- Work of the equilibrium bench: a pile of many layers. The same of 12,000 pieces:
-- --set pile.pieces_per_layer=300 --set pile.spawn_bounds=16,16,8
return rubble.mission {
  seed = 1,
  packs = { "concrete", "residential" },
  pile = {
    layers = 40,
    pieces_per_layer = 75,
    spawn_bounds = { 8, 8, 8 },
  },
}
