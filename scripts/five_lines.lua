-- The least that makes a mission: everything else has a default.
return rubble.mission {
  seed = 5,
  pile = { layers = 1, pieces_per_layer = 60 },
}
