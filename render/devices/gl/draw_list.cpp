#include "render/devices/gl/draw_list.h"

#include <algorithm>
#include <cstddef>

#include "render/gl/gl_traffic.h"

namespace rubble {

DrawList::DrawList(const Gl& gl, const GlGeometry& geometry)
    : gl_(&gl), command_buffer_(gl), record_buffer_(gl), array_(gl) {
  const GLuint a = array_.name();
  gl.VertexArrayVertexBuffer(a, 0, geometry.vertices.name(), 0, 16);
  gl.VertexArrayVertexBuffer(a, 1, record_buffer_.name(), 0, sizeof(DrawRecord));
  gl.VertexArrayBindingDivisor(a, 1, 1);
  gl.VertexArrayElementBuffer(a, geometry.indices.name());
  const auto attribute = [&](GLuint index, GLuint binding, GLint parts, std::size_t offset) {
    gl.EnableVertexArrayAttrib(a, index);
    gl.VertexArrayAttribFormat(a, index, parts, GL_FLOAT, GL_FALSE, GLuint(offset));
    gl.VertexArrayAttribBinding(a, index, binding);
  };
  attribute(0, 0, 3, 0);
  attribute(1, 1, 4, offsetof(DrawRecord, clip_x));
  attribute(2, 1, 4, offsetof(DrawRecord, clip_y));
  attribute(3, 1, 4, offsetof(DrawRecord, clip_w));
  gl.EnableVertexArrayAttrib(a, 4);
  gl.VertexArrayAttribIFormat(a, 4, 1, GL_UNSIGNED_INT, offsetof(DrawRecord, placed));
  gl.VertexArrayAttribBinding(a, 4, 1);
  attribute(5, 1, 4, offsetof(DrawRecord, clip_z));
}

void DrawList::add_run(std::uint32_t first_index, std::uint32_t count) {
  commands_.push_back({count, 1, first_index, 0, std::uint32_t(records_.size() - 1)});
}

void DrawList::give_records() {
  give_buffer(*gl_, record_buffer_.name(), std::max<std::size_t>(1, records_.size()) * sizeof(DrawRecord),
              records_.empty() ? nullptr : records_.data(), GL_STREAM_DRAW);
}

void DrawList::draw() {
  if (commands_.empty()) return;
  give_records();
  give_buffer(*gl_, command_buffer_.name(), commands_.size() * sizeof(DrawCommand), commands_.data(), GL_STREAM_DRAW);
  gl_->BindVertexArray(array_.name());
  gl_->BindBuffer(GL_DRAW_INDIRECT_BUFFER, command_buffer_.name());
  gl_->MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, GLsizei(commands_.size()),
                                 0);
}

void DrawList::draw(const GlBuffer& commands, const GlBuffer& count, GLsizei most) {
  gl_->BindVertexArray(array_.name());
  gl_->BindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  gl_->BindBuffer(GL_PARAMETER_BUFFER, count.name());
  gl_->MultiDrawElementsIndirectCount(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, 0, most, 0);
  gl_->BindBuffer(GL_PARAMETER_BUFFER, 0);  // Mesa takes counts from it in drawings without it, too
}

}  // namespace rubble
