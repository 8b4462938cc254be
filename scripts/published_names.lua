-- The parameters of the published Unity simulator, under its names. Axes are ours: Z is up.
return rubble.mission {
  randomseed = 3,
  numlayers = 2, numobjs = 30,
  spawnposx = 0, spawnposy = 0, spawnposz = 3,
  spawnboundx = 4, spawnboundy = 4, spawnboundz = 4,
  setlightrot = true, lightrotx = 0, lightroty = 60, lightrotz = 20,
  lighttype = "directional", lightintensity = 80,
  lightposx = 0, lightposy = 0, lightposz = 10,
  fogdensity = 0.02, fogintensity = 0.8,
  exportstl = true,
  camera = { width = 320, height = 240 },
}
