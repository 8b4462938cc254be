-- rubble.density.image(file): a density from a picture of the script's folder. White pixels get the most
-- pieces, black pixels none. The upper edge of the picture is at +Y.
return function(file)
  if type(file) ~= "string" then error("rubble.density.image takes the name of a picture", 2) end
  local image = rubble.read_image(file)
  if image.block > 1 then
    print(file .. ": averaged over blocks of " .. image.block .. " by " .. image.block .. " pixels to " ..
          image.columns .. " by " .. image.rows .. (image.cut_columns + image.cut_rows > 0 and ", without " ..
          image.cut_columns .. " columns and " .. image.cut_rows .. " rows at the edges, which fill no block" or ""))
  end
  local weights = {}
  for row = image.rows, 1, -1 do
    for column = 1, image.columns do
      local weight = image.values[(row - 1) * image.columns + column]
      if weight ~= weight or weight < 0 then error("rubble.density.image: " .. file .. " has values below 0, or none, in row " .. row, 2) end
      weights[#weights + 1] = weight
    end
  end
  return { columns = image.columns, rows = image.rows, weights = weights }
end
