-- rubble.density.image(file): a density from a PNG file of the script's folder. White pixels get the
-- most pieces, black pixels none. The upper edge of the picture is at +Y.
return function(file)
  if type(file) ~= "string" then error("rubble.density.image takes the name of a PNG file", 2) end
  local image = rubble.read_image(file)
  local weights = {}
  for row = image.rows, 1, -1 do
    for column = 1, image.columns do
      weights[#weights + 1] = image.values[(row - 1) * image.columns + column]
    end
  end
  return { columns = image.columns, rows = image.rows, weights = weights }
end
