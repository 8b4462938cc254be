-- A building that comes down: the columns along one side of its ground storey are gone, as after a lorry
-- went through them. What follows is computed: bonds that break, floors that fall on floors, and a
-- flight around the ruin and towards its voids.
return rubble.mission {
  seed = 11,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5, storey_height = 3,
    column = 0.35, beam_depth = 0.4, slab = 0.16, infill = "brick", openings = 0.4,
    cause = {
      removed = {
        { storey = 0, i = 0, j = 0 }, { storey = 0, i = 0, j = 1 }, { storey = 0, i = 0, j = 2 },
        { storey = 0, i = 1, j = 0 }, { storey = 0, i = 1, j = 1 },
      },
    },
  },
  camera = { width = 640, height = 480, fov_deg = 70 },
  lamp = { intensity_cd = 60 },
  trajectory = rubble.trajectory.orbit {
    radius_m = 14, height = 5, turns = 0.3, speed = 6,
  },
}
