// GLSL programs from the files under render/shaders/, which the build embeds into the library.
// Variants are made by compile-time defines: software drivers do not skip branches.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/gl/gl_objects.h"

namespace rubble {

struct ShaderFile {
  const char* name;  // path below render/shaders/
  const char* text;  // the whole file; never null but in the last
};
// Made by the build from render/shaders/*.glsl; ends with a null name.
extern const ShaderFile kShaderFiles[];

// Name and value; a value may be empty.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

// The text of `file` with #include "other.glsl" lines expanded and the version and defines in
// front, and the list of files that #line numbers refer to. Throws RunError for an unknown file.
struct ExpandedShader {
  std::string text;                // what the driver compiles
  std::vector<std::string> files;  // names by the number in #line
};
ExpandedShader expand_shader(const std::string& file, const ShaderDefines& defines);

// A compiler's log with "0:12" or "0(12)" replaced by "file.glsl:12".
std::string name_files_in_log(const std::string& log, const std::vector<std::string>& files);

// Compiles and links. Throws RunError with file:line of each error.
GlProgram make_program(const Gl& gl, const std::string& vertex_file,
                       const std::string& fragment_file, const ShaderDefines& defines = {});

// The same of texts; errors name `what`.
GlProgram make_program(const Gl& gl, const ExpandedShader& vertex, const ExpandedShader& fragment, const std::string& what);

// Of one compute shader.
GlProgram make_compute_program(const Gl& gl, const std::string& file, const ShaderDefines& defines = {});

// Says which texture unit each sampler reads; unknown names are ignored, since a variant may not
// use them all.
void bind_samplers(const Gl& gl, const GlProgram& program,
                   const std::vector<std::pair<const char*, int>>& units);

}  // namespace rubble
