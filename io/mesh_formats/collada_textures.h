// What assimp leaves out of the textures of a COLLADA document.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct ColladaTextures {
  std::string xml;                 // for assimp
  std::vector<std::string> notes;  // what is not drawn as the document says
};

// Assimp passes over <bind_vertex_input> and takes a digit in the `texcoord` of a <texture> for the place of its texture
// coordinates among those of the mesh: `texcoord` becomes that place where the document binds a set. Wrapping other than
// WRAP is noted.
ColladaTextures prepare_textures(const std::string& xml);

}  // namespace rubble
