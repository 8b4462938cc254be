return pack { name = "painted", assets = { { name = "painted_block", mesh = "block.gltf", material = "timber" } } }
