// Buffers that hold the commands of one multi-draw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/devices/gl/gl_geometry.h"

namespace rubble {

struct DrawCommand {  // as glMultiDrawElementsIndirect wants it
  std::uint32_t count, instances, first_index, base_vertex, base_instance;  // in GL's order
};

struct DrawRecord {  // attributes of one command, see shaders/visibility.vert.glsl
  float clip_x[4], clip_y[4], clip_w[4];  // rows of clip_from_mesh
  std::uint32_t placed, unused;           // number of the placed mesh; padding
  float clip_z[4];                        // for shadows; else the eye in the mesh
};

class DrawList {
 public:
  DrawList(const Gl& gl, const GlGeometry& geometry);

  void clear() { commands_.clear(), records_.clear(); }
  bool empty() const { return commands_.empty(); }
  void add_record(const DrawRecord& record) { records_.push_back(record); }
  // A run of triangles with the record added last.
  void add_run(std::uint32_t first_index, std::uint32_t count);
  void draw();
  // By commands and their number on the card, at most `most`, whose base instances are numbers of the records.
  void give_records();
  GLuint records() const { return record_buffer_.name(); }
  void draw(const GlBuffer& commands, const GlBuffer& count, GLsizei most);

 private:
  const Gl* gl_;
  std::vector<DrawCommand> commands_;
  std::vector<DrawRecord> records_;
  GlBuffer command_buffer_, record_buffer_;
  GlVertexArray array_;
};

}  // namespace rubble
