#include "render/gl/shader.h"

#include <cctype>
#include <sstream>
#include <string_view>

#include "kernel/base/error.h"

namespace rubble {

namespace {

const char* find_file(const std::string& name) {
  for (const ShaderFile* f = kShaderFiles; f->name; ++f)
    if (name == f->name) return f->text;
  throw RunError("the program holds no shader file " + name);
}

constexpr std::string_view kInclude = "#include \"";

void append_file(const std::string& name, ExpandedShader& out) {
  const std::size_t number = out.files.size();
  out.files.push_back(name);
  std::istringstream lines(find_file(name));
  std::string line;
  out.text += "#line 1 " + std::to_string(number) + "\n";
  for (int i = 1; std::getline(lines, line); ++i) {
    if (line.compare(0, kInclude.size(), kInclude) != 0) {
      out.text += line + "\n";
      continue;
    }
    const std::size_t end = line.find('"', kInclude.size());
    append_file(line.substr(kInclude.size(), end - kInclude.size()), out);
    out.text += "#line " + std::to_string(i + 1) + " " + std::to_string(number) + "\n";
  }
}

GLuint compile(const Gl& gl, GLenum kind, const ExpandedShader& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.text.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0, length = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(length > 0 ? length : 1), '\0');
  gl.GetShaderInfoLog(shader, GLsizei(log.size()), nullptr, &log[0]);
  gl.DeleteShader(shader);
  throw RunError("shader " + source.files.front() + " does not compile:\n" +
                 name_files_in_log(log.c_str(), source.files));
}

// The shaders are deleted.
GlProgram link(const Gl& gl, const std::vector<GLuint>& shaders, const std::string& what) {
  GlProgram program(gl);
  for (const GLuint shader : shaders) gl.AttachShader(program.name(), shader);
  gl.LinkProgram(program.name());
  for (const GLuint shader : shaders) gl.DeleteShader(shader);
  GLint ok = 0;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (ok) return program;
  std::string log(4096, '\0');
  gl.GetProgramInfoLog(program.name(), GLsizei(log.size()), nullptr, &log[0]);
  throw RunError("shaders " + what + " do not link:\n" + log.c_str());
}

// The length of "N:M" or "N(M)" at the start of `text`, and its numbers; 0 when there is none.
std::size_t match_position(std::string_view text, std::size_t& file, std::size_t& line) {
  const auto number = [&](std::size_t& at, std::size_t& value) {
    const std::size_t start = at;
    for (value = 0; at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])); ++at)
      value = value * 10 + std::size_t(text[at] - '0');
    return at > start;
  };
  std::size_t at = 0;
  if (!number(at, file) || at >= text.size()) return 0;
  const char separator = text[at++];
  if ((separator != ':' && separator != '(') || !number(at, line)) return 0;
  if (separator == '(' && (at >= text.size() || text[at++] != ')')) return 0;
  return at;
}

}  // namespace

ExpandedShader expand_shader(const std::string& file, const ShaderDefines& defines) {
  ExpandedShader out;
  out.text = "#version 450 core\n";
  for (const auto& [name, value] : defines) out.text += "#define " + name + " " + value + "\n";
  append_file(file, out);
  return out;
}

std::string name_files_in_log(const std::string& log, const std::vector<std::string>& files) {
  std::istringstream lines(log);
  std::string line, out;
  while (std::getline(lines, line)) {
    std::size_t file = 0, number = 0;
    const std::size_t length = match_position(line, file, number);
    if (length && file < files.size())
      line = files[file] + ":" + std::to_string(number) + line.substr(length);
    out += line + "\n";
  }
  return out;
}

GlProgram make_program(const Gl& gl, const std::string& vertex_file,
                       const std::string& fragment_file, const ShaderDefines& defines) {
  return make_program(gl, expand_shader(vertex_file, defines), expand_shader(fragment_file, defines),
                      vertex_file + " and " + fragment_file);
}

GlProgram make_program(const Gl& gl, const ExpandedShader& vertex_text, const ExpandedShader& fragment_text,
                       const std::string& what) {
  return link(gl, {compile(gl, GL_VERTEX_SHADER, vertex_text), compile(gl, GL_FRAGMENT_SHADER, fragment_text)}, what);
}

GlProgram make_compute_program(const Gl& gl, const std::string& file, const ShaderDefines& defines) {
  return link(gl, {compile(gl, GL_COMPUTE_SHADER, expand_shader(file, defines))}, file);
}

void bind_samplers(const Gl& gl, const GlProgram& program,
                   const std::vector<std::pair<const char*, int>>& units) {
  for (const auto& [name, unit] : units) {
    const GLint location = gl.GetUniformLocation(program.name(), name);
    if (location >= 0) gl.ProgramUniform1i(program.name(), location, unit);
  }
}

}  // namespace rubble
