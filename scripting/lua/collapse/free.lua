-- rubble.collapse.free: pieces placed one by one, as in `pile.placed`. They are moved and rotated
-- together, and covered with debris like any other mode.
return function(given)
  local o = rubble.options("rubble.collapse.free", given, rubble.structure_options {
    { "pieces", {}, type = "table", doc = "As `pile.placed`, relative to the origin of the structure." },
  })
  for key in pairs(o.pieces) do
    if type(key) ~= "number" then
      rubble.reject("rubble.collapse.free", "pieces", "a list of pieces {{...}, {...}}", o.pieces)
      break
    end
  end
  return rubble.assemble(o, o.pieces)
end
