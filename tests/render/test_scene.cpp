#include "tests/render/test_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble::testing {

namespace {

using std::uint32_t;

void add_quad(TriangleMesh& mesh, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
  const uint32_t i = uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.triangles.push_back({i, i + 1, i + 2});
  mesh.triangles.push_back({i, i + 2, i + 3});
  mesh.surfaces.insert(mesh.surfaces.end(), 2, std::uint8_t(0));
}

}  // namespace

TriangleMesh make_box(const Vec3& size, const char* surface) {
  TriangleMesh mesh;
  mesh.surface_names = {surface};
  const Vec3f h(size * 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = -1; side <= 1; side += 2) {
      Vec3f n, u, v;
      n[axis] = h[axis] * float(side);
      u[(axis + 1) % 3] = h[(axis + 1) % 3] * float(side);
      v[(axis + 2) % 3] = h[(axis + 2) % 3];
      add_quad(mesh, n - u - v, n + u - v, n + u + v, n - u + v);
    }
  }
  return mesh;
}

TriangleMesh make_sphere(int rings, const char* surface) {
  TriangleMesh mesh;
  mesh.surface_names = {surface};
  const auto point = [&](int ring, int step) {
    const portable::SinCos a = portable::sincos(portable::kPi * ring / rings);
    const portable::SinCos b = portable::sincos(portable::kPi * (step % (2 * rings)) / rings);
    return Vec3f(float(a.sin * b.cos), float(a.sin * b.sin), float(a.cos));
  };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < 2 * rings; ++s)
      add_quad(mesh, point(r, s), point(r + 1, s), point(r + 1, s + 1), point(r, s + 1));
  mesh.normals = mesh.positions;
  return mesh;
}

// A sphere pressed against planes: the planes are the cast faces, the rest is broken.
TriangleMesh make_chunk(std::uint64_t seed, const char* cast, const char* broken) {
  RandomStream random(seed, "test.chunk");
  TriangleMesh mesh = make_sphere(14, cast);
  mesh.surface_names.push_back(broken);
  mesh.normals.clear();
  struct Plane {
    Vec3f normal;
    float reach;
  };
  std::vector<Plane> planes;
  for (int i = 0; i < 7; ++i)
    planes.push_back({Vec3f(random.direction()), float(random.uniform(0.3, 0.48))});
  std::map<std::array<float, 3>, Vec3f> moved;  // the same bump for equal positions
  for (Vec3f& p : mesh.positions) {
    const std::array<float, 3> key{p.x, p.y, p.z};
    const auto at = moved.find(key);
    if (at != moved.end()) {
      p = at->second;
      continue;
    }
    float reach = 0.5f;
    std::size_t which = planes.size();
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const float c = dot(p, planes[i].normal);
      if (c > 0 && planes[i].reach / c < reach) reach = planes[i].reach / c, which = i;
    }
    if (which >= 3) reach *= float(random.uniform(0.95, 1.0));
    p *= reach;
    moved[key] = p;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec3f mid;
    for (uint32_t v : mesh.triangles[t]) mid += mesh.positions[v] * (1.0f / 3);
    bool flat = false;
    for (std::size_t i = 0; i < 3; ++i)
      flat |= dot(mid, planes[i].normal) > planes[i].reach * 0.995f;
    mesh.surfaces[t] = flat ? 0 : 1;
  }
  return mesh;
}

std::shared_ptr<const SceneMesh> share(TriangleMesh mesh) {
  auto out = std::make_shared<SceneMesh>();
  out->levels.push_back(std::move(mesh));
  return out;
}

Scene make_heap(int pieces, std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  RandomStream random(seed, "test.heap");
  for (std::uint64_t i = 0; i < 5; ++i)
    scene.meshes.push_back(share(make_chunk(seed + i, "concrete_cast", "concrete_fracture")));
  for (std::uint64_t i = 0; i < 2; ++i)
    scene.meshes.push_back(share(make_chunk(seed + 50 + i, "brick", "brick_fracture")));
  scene.meshes.push_back(share(make_box({1.2, 0.8, 0.16})));
  scene.meshes.push_back(share(make_box({0.24, 0.115, 0.07}, "brick")));
  scene.meshes.push_back(share(make_box({0.4, 0.2, 0.2}, "cinder_block")));
  scene.meshes.push_back(share(make_box({1.3, 0.016, 0.016}, "rebar")));
  scene.meshes.push_back(share(make_box({1.1, 0.1, 0.05}, "timber")));
  scene.meshes.push_back(share(make_box({0.7, 0.5, 0.013}, "plaster")));
  const uint32_t roof = uint32_t(scene.meshes.size());
  scene.meshes.push_back(share(make_box({3.4, 3.0, 0.2})));
  scene.meshes.push_back(share(make_box({3.0, 0.25, 1.3})));
  scene.meshes.push_back(share(make_box({0.25, 2.4, 1.3})));
  const WeightedChoice choice({4, 4, 4, 4, 4, 4, 4, 2, 8, 3, 1.5, 1, 1});
  const auto add = [&](uint32_t mesh, const Pose& pose, float scale) {
    scene.instances.push_back({mesh, scale, pose, uint32_t(scene.instances.size())});
  };
  add(roof, {{}, {0, 0, 1.4}}, 1);
  add(roof + 1, {{}, {0, 1.325, 0.65}}, 1);
  add(roof + 1, {{}, {0, -1.325, 0.65}}, 1);
  add(roof + 2, {{}, {-1.6, 0, 0.65}}, 1);
  while (int(scene.instances.size()) < pieces) {
    const uint32_t mesh = uint32_t(choice.draw(random));
    const double size = mesh < 7 ? random.uniform(0.25, 0.75) : 1.0;
    const double x = random.uniform(-4.5, 4.5), y = random.uniform(-4.5, 4.5);
    const double top = std::max(0.05, 2.4 * (1 - std::sqrt(x * x + y * y) / 4.6));
    const double z = 0.12 + random.uniform(0, 1) * top;
    const bool in_void =
        x > -2.2 && x < 4.6 && std::fabs(y) < 1.2 + 0.12 * (x > 1.5 ? x - 1.5 : 0) && z < 1.6;
    const Quat turn = mesh >= 7 && mesh < 10
                          ? portable::quat_from_rpy(random.normal() * 0.5, random.normal() * 0.5,
                                                    random.uniform(0, 6.28))
                          : random.rotation();
    if (!in_void) add(mesh, {turn, {x, y, z}}, float(size));
  }
  for (int i = 0; i < 40; ++i)  // small debris on the floor
    add(uint32_t(random.below(7)),
        {random.rotation(), {random.uniform(-1.4, 3), random.uniform(-1.1, 1.1), 0.03}},
        float(random.uniform(0.06, 0.2)));
  return scene;
}

Pose look_at(const Vec3& eye, const Vec3& target) {
  const Vec3 forward = normalized(target - eye);
  const double yaw = portable::atan2(forward.y, forward.x);
  const double pitch = -portable::asin(std::clamp(forward.z, -1.0, 1.0));
  return {portable::quat_from_rpy(0, pitch, yaw), eye};
}

Intrinsics pinhole(int width, int height, double focal) {
  Intrinsics k;
  k.width = width, k.height = height;
  k.fx = k.fy = focal;
  k.cx = 0.5 * (width - 1), k.cy = 0.5 * (height - 1);
  return k;
}

Scene slab_room(const Vec3& inside) {
  Scene scene;
  scene.ground = false;
  scene.lamp = {true, 100, 60, {0, 0.05, 0.05}};
  scene.light.type = LightType::point;
  scene.light.intensity = 0, scene.light.position = {0, 0, 50};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 size = inside + Vec3(0.4, 0.4, 0.4), place;
    size[axis] = 0.2;
    scene.meshes.push_back(share(make_box(size, "plaster")));
    for (const double side : {-0.5, 0.5}) {
      place = Vec3();
      place[axis] = side * (inside[axis] + 0.2);
      scene.instances.push_back({std::uint32_t(axis), 1, {{}, place}, std::uint32_t(scene.instances.size() + 1)});
    }
  }
  return scene;
}

}  // namespace rubble::testing
