-- rubble.slab { from =, size =, pitch_deg =, yaw_deg =, ... }: a box as an entry of `pile.placed`,
-- given by the middle of the lower edge at its -X end, from which it runs along its own X axis. A
-- positive pitch goes down. Other keys (fixed, broken, material) are taken over.
return function(given)
  local slab = {}
  for name, value in pairs(given) do slab[name] = value end
  slab.from, slab.size, slab.pitch_deg, slab.yaw_deg = nil, nil, nil, nil
  slab.box, slab.rpy_deg = given.size, { 0, given.pitch_deg or 0, given.yaw_deg or 0 }
  local middle = rubble.rotate(slab.rpy_deg, { given.size[1] / 2, 0, given.size[3] / 2 })
  slab.position = { given.from[1] + middle.x, given.from[2] + middle.y, given.from[3] + middle.z }
  return slab
end
