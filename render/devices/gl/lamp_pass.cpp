#include "render/devices/gl/lamp_pass.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "render/geometry/scene_tables.h"
#include "render/gl/shader.h"

namespace rubble {

namespace {

constexpr std::uint32_t kGroup = 64, kGroupsARow = 32768;  // local_size_x of the shaders; at most

constexpr std::size_t kListHead = 16;  // of the lists in shaders/lamp_shown.comp.glsl; unit: byte

// Mirror the structures in shaders/lamp_words.glsl and lamp_nodes.comp.glsl.
struct AimBlock {
  float place[4] = {}, axis[4] = {}, intensity[4] = {};
  std::uint32_t seen_count = 0, point_count = 0, links_a_point = 0, unused_a = 0;
  float reach = 0, fade = 0, near = 0, slack = 0;
  std::int32_t map_side = 0;
  float air_off = 0, unused[2] = {};
  float air_origin[4] = {}, air_cell[4] = {};
  std::int32_t air_size[4] = {};
};
struct PointEntry {
  Vec3f position;
  std::uint32_t normal;
  Vec3f albedo;
  std::uint32_t stand_in;
};
struct SeenEntry {
  std::uint32_t first_point, points_before;
};
struct NodeEntry {
  Vec3f position;
  std::uint32_t normal;
  std::array<float, 4> weights;
};
using FourNumbers = std::array<std::uint32_t, 4>;
static_assert(sizeof(PointEntry) == 32 && sizeof(NodeEntry) == 32, "as the shaders read them");

void set(float (&out)[4], const Vec3f& v, float last) { out[0] = v.x, out[1] = v.y, out[2] = v.z, out[3] = last; }

GlProgram make_lamp_program(const Gl& gl, const char* file, const ShaderDefines& defines = {}) {
  GlProgram program = make_compute_program(gl, std::string("lamp_") + file + ".comp.glsl", defines);
  bind_samplers(gl, program,
                {{"visibility", 0},
                 {"triangle_table", 1},
                 {"light_table", 2},
                 {"piece_rows", 3},
                 {"lamp_terms", 4},
                 {"lamp_stand_in", 5}});
  return program;
}

GlBuffer make_room(const Gl& gl, std::size_t bytes) {
  GlBuffer buffer(gl);
  give_buffer(gl, buffer.name(), std::max<std::size_t>(bytes, 16), nullptr, GL_DYNAMIC_COPY);
  return buffer;
}

void clear(const Gl& gl, const GlBuffer& buffer) {
  gl.ClearNamedBufferData(buffer.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

}  // namespace

LampPass::LampPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry, const BakeLinks& links,
                   const std::vector<std::uint32_t>& first_point)
    : gl_(gl),
      scene_(scene),
      geometry_(geometry),
      links_a_point_(std::uint32_t(links.per_point)),
      point_count_(links.places.size()),
      first_point_(first_point),
      programs_{make_lamp_program(gl, "send"),
                make_lamp_program(gl, "once"),
                make_lamp_program(gl, "share"),
                make_lamp_program(gl, "again"),
                make_lamp_program(gl, "shown"),
                make_lamp_program(gl, "arrive"),
                make_lamp_program(gl, "nodes"),
                make_lamp_program(gl, "nodes", {{"FOG", ""}}),
                make_lamp_program(gl, "nodes", {{"RESTORE", ""}})},
      aim_(gl),
      seen_(gl),
      seen_pieces_(gl),
      map_(gl) {
  give_scene(scene, links, first_point);
  const std::size_t bits = (point_count_ / 32 + 1) * 4, groups = point_count_ / kGroup + 1 + kGroupsARow;
  radiance_ = make_room(gl, point_count_ * 16), once_ = make_room(gl, point_count_ * 16);
  arrived_ = make_room(gl, point_count_ * 32), sums_ = make_room(gl, groups * 8), share_ = make_room(gl, 16);
  lit_ = make_room(gl, bits), point_shows_ = make_room(gl, bits);
  node_shows_ = make_room(gl, (scene.light_nodes / 32 + 1) * 4);
  node_list_ = make_room(gl, kListHead + scene.light_nodes * 8), point_list_ = make_room(gl, kListHead + point_count_ * 4);
  shown_ = make_room(gl, scene.light_nodes * sizeof(BakedLight));
  shown_view_ = make_buffer_texture(gl, shown_, GL_RG32UI);
  check_gl(gl, "preparing the lamp's light");
}

void LampPass::give_scene(const PreparedScene& scene, const BakeLinks& links,
                          const std::vector<std::uint32_t>& first_point) {
  std::vector<PointEntry> points(point_count_);
  for (std::size_t i = 0; i < point_count_; ++i)
    points[i] = {links.places[i].position, pack_normal(links.places[i].normal), links.albedos[i], links.stand_ins()[i]};
  points_ = make_buffer(gl_, points), links_ = make_buffer(gl_, links.hits());
  std::vector<NodeEntry> nodes;
  std::vector<FourNumbers> node_points;
  std::vector<std::uint32_t> first_node;  // of each mesh
  for (const PreparedMesh& mesh : scene.meshes) {
    first_node.push_back(std::uint32_t(nodes.size()));
    for (const LightNode& node : mesh.light_nodes) {
      nodes.push_back({node.position, pack_normal(node.normal), node.weights});
      node_points.push_back(node.points);
    }
  }
  nodes_ = make_buffer(gl_, nodes), node_points_ = make_buffer(gl_, node_points);
  std::vector<FourNumbers> pieces;
  std::vector<std::array<float, 4>> rows;
  for (std::size_t k = 0; k < scene.placed.size(); ++k) {
    const PlacedMesh& piece = scene.placed[k];
    pieces.push_back({first_point[k], piece.first_light, first_node[piece.mesh], geometry_.tables.first_vertex[piece.mesh]});
    const Mat3 r = piece.world_from_mesh.rotation.matrix();
    for (int i = 0; i < 3; ++i) {
      const Vec3 row = r.rows[std::size_t(i)] * piece.scale;
      rows.push_back({float(row.x), float(row.y), float(row.z), float(piece.world_from_mesh.translation[i])});
    }
  }
  pieces_ = make_buffer(gl_, pieces), piece_rows_ = make_buffer(gl_, rows);
  piece_rows_view_ = make_buffer_texture(gl_, piece_rows_, GL_RGBA32F);
}

void LampPass::light(const LampAim& aim, const LampAir* air) {
  lit_by_ = aim, pending_ = true;
  air_.reset();
  if (air) air_ = *air;
}

void LampPass::put_out() { lit_by_.reset(), pending_ = false; }

void LampPass::run(const GlProgram& program, std::initializer_list<GLuint> buffers, std::uint32_t count) {
  GLuint binding = 0;
  for (const GLuint buffer : buffers) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer);
  const std::uint32_t groups = (count + kGroup - 1) / kGroup, row = std::min(groups, kGroupsARow);
  if (groups == 0) return;
  gl_.UseProgram(program.name());
  gl_.DispatchCompute(row, (groups + row - 1) / row, 1);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void LampPass::run(const GlProgram& program, std::initializer_list<GLuint> buffers, const GlBuffer& list) {
  GLuint binding = 0;
  for (const GLuint buffer : buffers) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer);
  gl_.UseProgram(program.name());
  gl_.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, list.name());
  gl_.DispatchComputeIndirect(0);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void LampPass::give_aim() {
  AimBlock aim;
  const LampAim& lamp = *lit_by_;
  set(aim.place, lamp.position, lamp.extinction), set(aim.axis, lamp.axis, lamp.cone), set(aim.intensity, lamp.intensity, 0);
  aim.reach = lamp.reach, aim.fade = lamp.fade, aim.near = lamp.near, aim.slack = lamp.slack, aim.map_side = lamp.map_side;
  std::vector<SeenEntry> seen;
  std::vector<std::uint32_t> seen_pieces(scene_.placed.size() / 32 + 1);
  seen_points_ = 0;
  for (const std::uint32_t piece : *lamp.seen) {
    seen.push_back({first_point_[piece], seen_points_});
    seen_pieces[piece / 32] |= 1u << piece % 32;
    seen_points_ += std::uint32_t(scene_.meshes[scene_.placed[piece].mesh].bake_points.size());
  }
  aim.seen_count = std::uint32_t(seen.size()), aim.point_count = seen_points_, aim.links_a_point = links_a_point_;
  if (air_) {
    const AirGrid& grid = air_->links->grid;
    aim.air_off = air_->off;
    set(aim.air_origin, grid.origin, 0), set(aim.air_cell, grid.cell, 0);
    for (std::size_t i = 0; i < 3; ++i) aim.air_size[i] = grid.size[i];
  }
  give_buffer(gl_, aim_.name(), sizeof aim, &aim, GL_STREAM_DRAW);
  if (!seen.empty()) give_buffer(gl_, seen_.name(), seen.size() * sizeof(SeenEntry), seen.data(), GL_STREAM_DRAW);
  give_buffer(gl_, seen_pieces_.name(), seen_pieces.size() * 4, seen_pieces.data(), GL_STREAM_DRAW);
  give_buffer(gl_, map_.name(), lamp.map->size() * sizeof(float), lamp.map->data(), GL_STREAM_DRAW);
}

void LampPass::pass_on() {
  clear(gl_, lit_);
  const GLuint aim = aim_.name(), seen = seen_.name(), points = points_.name();
  const GLuint radiance = radiance_.name(), lit = lit_.name();
  run(programs_.send, {aim, seen, map_.name(), points, radiance, lit}, seen_points_);
  run(programs_.once, {aim, seen, links_.name(), points, radiance, lit, once_.name(), sums_.name()}, seen_points_);
  run(programs_.share, {aim, seen, once_.name(), points, radiance, lit, share_.name(), sums_.name()}, 1);
  run(programs_.again, {aim, seen, once_.name(), points, radiance, lit, share_.name()}, seen_points_);
}

// What it showed of the lamp's light goes.
void LampPass::restore() {
  if (base_version_ != geometry_.light_version) {
    base_version_ = geometry_.light_version;
    gl_.CopyNamedBufferSubData(geometry_.light.name(), shown_.name(), 0, 0, GLsizeiptr(geometry_.light.size()));
  } else if (shows_) {
    gl_.BindTextureUnit(2, geometry_.light_view.name());
    run(programs_.restore,
        {aim_.name(), seen_.name(), pieces_.name(), nodes_.name(), node_points_.name(), node_list_.name(), arrived_.name(),
         shown_.name()},
        node_list_);
  }
  shows_ = false;
}

void LampPass::find(const GlBuffer& frame) {
  if (!pending_) return;
  pending_ = false;
  restore();
  give_aim();
  pass_on();
  fog_shown_ = nullptr;
  if (air_) {
    if (!fog_) fog_ = std::make_unique<LampFogPass>(gl_, *air_, lit_by_->reach);
    fog_->find(*air_, {aim_.name(), seen_.name(), map_.name(), radiance_.name(), lit_.name(), radiance_, frame});
    fog_shown_ = fog_.get();
  }
  check_gl(gl_, "finding the lamp's light");
}

const GlTexture& LampPass::light_of(const GlTexture& ids, int width, int height) {
  restore();
  shows_ = true;
  clear(gl_, node_shows_), clear(gl_, point_shows_);
  const std::uint32_t empty[4] = {0, 1, 1, 0};
  for (const GlBuffer* list : {&node_list_, &point_list_}) give_buffer_part(gl_, list->name(), 0, sizeof empty, empty);
  gl_.BindTextureUnit(0, ids.name()), gl_.BindTextureUnit(1, geometry_.triangles_view.name());
  const GLuint aim = aim_.name(), seen = seen_.name();
  mark_shown(width, height);
  run(programs_.arrive,
      {aim, seen, links_.name(), points_.name(), radiance_.name(), lit_.name(), point_list_.name(), arrived_.name()},
      point_list_);
  gl_.BindTextureUnit(2, geometry_.light_view.name()), gl_.BindTextureUnit(3, piece_rows_view_.name());
  if (fog_shown_) gl_.BindTextureUnit(4, fog_->terms().name()), gl_.BindTextureUnit(5, fog_->stand_in().name());
  run(fog_shown_ ? programs_.nodes_in_fog : programs_.nodes,
      {aim, seen, pieces_.name(), nodes_.name(), node_points_.name(), node_list_.name(), arrived_.name(), shown_.name()},
      node_list_);
  check_gl(gl_, "adding the lamp's light");
  return shown_view_;
}

// Of the picture that is bound.
void LampPass::mark_shown(int width, int height) {
  const GLuint buffers[] = {pieces_.name(),      node_points_.name(), seen_pieces_.name(), node_shows_.name(),
                            point_shows_.name(), node_list_.name(),   point_list_.name()};
  for (GLuint k = 0; k < 7; ++k) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, k, buffers[k]);
  gl_.UseProgram(programs_.shown.name());
  gl_.DispatchCompute(GLuint(width + 7) / 8, GLuint(height + 7) / 8, 1);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace rubble
