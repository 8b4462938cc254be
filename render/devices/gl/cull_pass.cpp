#include "render/devices/gl/cull_pass.h"

#include <algorithm>
#include <array>

#include "render/camera/culling.h"
#include "render/camera/projection.h"
#include "render/gl/shader.h"

namespace rubble {

namespace {

constexpr GLuint kCandidatesAGroup = 64;

// Mirror shaders/cull_words.glsl.
struct ClusterEntry {
  float centre[4], half_sides[4], axis[4];
  std::uint32_t first_index, index_count, unused[2];
};
struct CandidateEntry {
  std::uint32_t first_cluster, cluster_count, first_flag, wanted_without_history;
};

int tiles_in(int pixels) { return (pixels + DepthPyramid::kTile - 1) / DepthPyramid::kTile; }

ClusterEntry entry_of(const Cluster& c, std::uint32_t first_index) {
  return {{c.centre.x, c.centre.y, c.centre.z, c.radius},
          {c.half.x, c.half.y, c.half.z, c.cone_cosine},
          {c.cone_axis.x, c.cone_axis.y, c.cone_axis.z, 0},
          first_index,
          3 * c.triangle_count,
          {0, 0}};
}

}  // namespace

CullPass::CullPass(const Gl& gl, const PreparedScene& scene, const GlGeometry& geometry)
    : gl_(gl),
      scene_(scene),
      programs_{make_compute_program(gl, "cull.comp.glsl"),
                make_compute_program(gl, "cull.comp.glsl", {{"SECOND", ""}}),
                make_compute_program(gl, "cull_scan.comp.glsl"),
                make_compute_program(gl, "cull_emit.comp.glsl"),
                make_compute_program(gl, "depth_pyramid.comp.glsl", {{"FIRST", ""}}),
                make_compute_program(gl, "depth_pyramid.comp.glsl")},
      flags_(make_buffer(gl, std::vector<std::uint32_t>(scene.cluster_flags))),
      candidates_(gl),
      runs_(gl),
      pyramid_(gl),
      commands_(gl),
      count_(gl),
      triangles_(gl) {
  bind_samplers(gl, programs_.pyramid_first, {{"depth", 0}});
  give_clusters(scene, geometry);
  give_buffer(gl, runs_.name(), (scene.placed.size() + 1) * 4, nullptr, GL_DYNAMIC_COPY);
  give_buffer(gl, commands_.name(), (scene.cluster_flags + 1) * sizeof(DrawCommand), nullptr, GL_DYNAMIC_COPY);
  give_buffer(gl, count_.name(), 16, nullptr, GL_DYNAMIC_COPY);
  check_gl(gl, "preparing to choose what is drawn");
}

// Of a coarse level all is one.
void CullPass::give_clusters(const PreparedScene& scene, const GlGeometry& geometry) {
  std::vector<ClusterEntry> out;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const PreparedMesh& mesh = scene.meshes[m];
    std::vector<std::uint32_t>& first = first_cluster_.emplace_back();
    for (std::size_t level = 0; level < mesh.levels.size(); ++level) {
      const PreparedLevel& of = mesh.levels[level];
      first.push_back(std::uint32_t(out.size()));
      if (level > 0) {
        Cluster whole;
        whole.centre = mesh.centre, whole.half = mesh.half, whole.radius = mesh.radius;
        whole.triangle_count = of.triangle_count;
        out.push_back(entry_of(whole, geometry.first_index(m, of.first_triangle)));
        continue;
      }
      for (std::uint32_t k = of.first_cluster; k < of.first_cluster + of.cluster_count; ++k)
        out.push_back(entry_of(mesh.clusters[k], geometry.first_index(m, mesh.clusters[k].first_triangle)));
    }
  }
  clusters_ = make_buffer(gl_, out);
}

void CullPass::begin(const std::vector<DrawCandidate>& candidates, DrawList& list, int width, int height) {
  std::vector<CandidateEntry> entries;
  std::size_t triangles = 0;
  most_runs_ = 0;
  for (const DrawCandidate& candidate : candidates) {
    const PlacedMesh& piece = scene_.placed[candidate.placed];
    const PreparedLevel& level = scene_.meshes[piece.mesh].levels[candidate.level];
    const std::uint32_t count = candidate.level > 0 ? 1 : level.cluster_count;
    entries.push_back({first_cluster_[piece.mesh][candidate.level], count, piece.first_flag, triangles <= kFirstBatch});
    triangles += level.triangle_count, most_runs_ += count;
  }
  candidate_count_ = GLint(entries.size()), width_ = width, height_ = height;
  if (!entries.empty())
    give_buffer(gl_, candidates_.name(), entries.size() * sizeof(CandidateEntry), entries.data(), GL_STREAM_DRAW);
  list.give_records();
  const std::uint32_t none[4] = {};
  give_buffer(gl_, triangles_.name(), sizeof none, none, GL_STREAM_DRAW);
}

void CullPass::draw(DrawList& list, const GlProgram& choose, const Prepare& prepare) {
  if (candidate_count_ == 0) return;
  GLuint binding = 0;
  for (const GLuint buffer : {clusters_.name(), list.records(), candidates_.name(), flags_.name(), runs_.name()})
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer);
  const GLuint groups = (GLuint(candidate_count_) + kCandidatesAGroup - 1) / kCandidatesAGroup;
  const auto run = [&](const GlProgram& program, GLuint fifth, GLuint sixth, GLuint of_groups) {
    if (fifth) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, fifth);
    if (sixth) gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, sixth);
    gl_.ProgramUniform1i(program.name(), gl_.GetUniformLocation(program.name(), "candidate_count"), candidate_count_);
    gl_.UseProgram(program.name());
    gl_.DispatchCompute(of_groups, 1, 1);
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  };
  const auto place = [&](const char* uniform) { return gl_.GetUniformLocation(choose.name(), uniform); };
  gl_.ProgramUniform4f(choose.name(), place("image"), float(width_), float(height_), kNearPlane, drawn_before_ ? 1.0f : 0.0f);
  gl_.ProgramUniform2i(choose.name(), place("first_tiles"), tiles_in(width_), tiles_in(height_));
  run(choose, pyramid_.name(), 0, groups);
  run(programs_.scan, 0, count_.name(), 1);
  run(programs_.emit, commands_.name(), triangles_.name(), groups);
  prepare();
  list.draw(commands_, count_, GLsizei(most_runs_));
}

void CullPass::draw_first(DrawList& list, const Prepare& prepare) { draw(list, programs_.first, prepare); }

void CullPass::draw_others(DrawList& list, const GlTexture& depth, const Prepare& prepare) {
  build_pyramid(depth);
  draw(list, programs_.others, prepare);
  drawn_before_ = true;
}

void CullPass::build_pyramid(const GlTexture& depth) {
  constexpr int kGroup = 8;  // local_size of the shader, along either axis
  std::array<std::pair<int, int>, 32> sizes;
  std::size_t levels = 0, all = 0;
  for (int x = tiles_in(width_), y = tiles_in(height_);; x = (x + 1) / 2, y = (y + 1) / 2) {
    sizes[levels++] = {x, y}, all += std::size_t(x) * std::size_t(y);
    if (x == 1 && y == 1) break;
  }
  give_buffer(gl_, pyramid_.name(), all * 4, nullptr, GL_STREAM_COPY);
  gl_.BindTextureUnit(0, depth.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, pyramid_.name());
  for (std::size_t k = 0, first = 0, before = 0; k < levels; ++k) {
    const GLuint program = (k == 0 ? programs_.pyramid_first : programs_.pyramid).name();
    const auto [x, y] = sizes[k];
    gl_.ProgramUniform4i(program, gl_.GetUniformLocation(program, "level"), x, y, GLint(first), GLint(before));
    if (k > 0)
      gl_.ProgramUniform2i(program, gl_.GetUniformLocation(program, "before_size"), sizes[k - 1].first, sizes[k - 1].second);
    gl_.UseProgram(program);
    gl_.DispatchCompute(GLuint((x + kGroup - 1) / kGroup), GLuint((y + kGroup - 1) / kGroup), 1);
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    before = first, first += std::size_t(x) * std::size_t(y);
  }
}

}  // namespace rubble
