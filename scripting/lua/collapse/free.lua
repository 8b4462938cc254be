-- rubble.collapse.free: pieces placed one by one, as in `pile.placed`, moved and turned together and
-- covered with debris like any other mode.
return function(given)
  local o = rubble.options("rubble.collapse.free", given, rubble.structure_options {
    { "pieces", {}, type = "table", doc = "As `pile.placed`, about the structure's origin." },
  })
  return rubble.assemble(o, o.pieces)
end
