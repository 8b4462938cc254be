-- Blocks with colours of their own: an image that has no symmetry, and colours of vertices.
return pack {
  name = "judge_pack",
  assets = {
    { name = "crate", mesh = "crate.obj", material = "timber", scale = { 0.8, 1.2 } },
    { name = "scan", mesh = "scan.ply", material = "timber", scale = { 0.8, 1.2 } },
  },
}
