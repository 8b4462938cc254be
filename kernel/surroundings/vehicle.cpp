#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/surroundings/parts.h"

namespace rubble {

namespace {

// A station along a vehicle: heights of waistline and top, half widths at the waist and at the top.
struct Station {
  double x, waist, top, half, top_half;
  bool glass_before;  // between this and the station before, above the waist
  bool screen;        // and the face on top of that is a windscreen
};

struct Body {
  std::vector<Station> stations;  // from front to rear
  double length, floor, wheel, front_axle, rear_axle;  // unit: m
};

// Lengths and heights of usual cars: 3.9 to 4.9 m by 1.75 to 2.0 m, 1.45 to 2.4 m high .
const std::array<Body, 3>& bodies() {
  static const std::array<Body, 3> all = {{
      {{{2.08, 0.60, 0.62, 0.62, 0.50, false, false},
        {1.98, 0.70, 0.74, 0.80, 0.62, false, false},
        {1.35, 0.84, 0.92, 0.87, 0.72, false, false},
        {0.92, 0.90, 0.98, 0.88, 0.74, false, false},
        {0.30, 0.92, 1.40, 0.88, 0.62, true, true},
        {0.18, 0.92, 1.44, 0.88, 0.62, false, false},
        {-0.55, 0.93, 1.47, 0.88, 0.62, true, false},
        {-0.66, 0.93, 1.47, 0.88, 0.62, false, false},
        {-1.42, 0.95, 1.41, 0.87, 0.60, true, false},
        {-1.60, 0.95, 1.36, 0.86, 0.59, false, false},
        {-1.98, 0.94, 1.02, 0.82, 0.66, true, true},
        {-2.06, 0.80, 0.84, 0.74, 0.62, false, false},
        {-2.10, 0.60, 0.62, 0.66, 0.55, false, false}},
       4.18, 0.20, 0.31, 1.32, -1.28},
      {{{2.34, 0.56, 0.58, 0.62, 0.50, false, false},
        {2.22, 0.68, 0.72, 0.82, 0.64, false, false},
        {1.45, 0.82, 0.90, 0.89, 0.74, false, false},
        {1.00, 0.88, 0.96, 0.90, 0.76, false, false},
        {0.28, 0.90, 1.36, 0.90, 0.60, true, true},
        {0.14, 0.90, 1.40, 0.90, 0.60, false, false},
        {-0.58, 0.92, 1.43, 0.90, 0.60, true, false},
        {-0.68, 0.92, 1.43, 0.90, 0.60, false, false},
        {-1.22, 0.94, 1.36, 0.90, 0.58, true, false},
        {-1.36, 0.94, 1.32, 0.90, 0.58, false, false},
        {-1.84, 0.98, 1.05, 0.88, 0.72, true, true},
        {-2.28, 0.96, 1.01, 0.82, 0.68, false, false},
        {-2.36, 0.62, 0.64, 0.70, 0.58, false, false}},
       4.70, 0.19, 0.32, 1.42, -1.40},
      {{{2.42, 0.62, 0.64, 0.74, 0.62, false, false},
        {2.34, 0.95, 1.00, 0.90, 0.74, false, false},
        {1.95, 1.08, 1.14, 0.95, 0.78, false, false},
        {1.30, 1.14, 1.82, 0.97, 0.76, true, true},
        {1.15, 1.14, 1.88, 0.97, 0.78, false, false},
        {0.40, 1.14, 1.95, 0.97, 0.80, true, false},
        {0.25, 1.14, 1.95, 0.97, 0.80, false, false},
        {-1.00, 1.14, 1.96, 0.97, 0.80, false, false},
        {-2.32, 1.14, 1.94, 0.97, 0.80, false, false},
        {-2.44, 1.10, 1.88, 0.94, 0.78, false, false},
        {-2.46, 0.60, 0.62, 0.84, 0.70, false, false}},
       4.90, 0.22, 0.33, 1.50, -1.55},
  }};
  return all;
}

constexpr int kRing = 10;  // points of a cross-section

std::array<Vec3, kRing> ring_of(const Station& s, double floor) {
  const double w = s.half, t = s.top_half, mid = floor + 0.45 * (s.waist - floor);
  const double low = std::min(floor, s.waist - 0.1);
  std::array<Vec3, kRing> out;
  const double ys[5] = {-0.82 * w, -0.985 * w, -1.0 * w, -0.97 * w, -t};
  const double zs[5] = {low, low + 0.10, mid, s.waist, s.top};
  for (std::size_t i = 0; i < 5; ++i)
    out[i] = {s.x, ys[i], zs[i]}, out[kRing - 1 - i] = {s.x, -ys[i], zs[i]};
  return out;
}

void add_body(const Body& body, const std::string& paint, MeshBuilder& out) {
  for (std::size_t k = 0; k + 1 < body.stations.size(); ++k) {
    const Station &a = body.stations[k], &b = body.stations[k + 1];
    const auto p = ring_of(a, body.floor), q = ring_of(b, body.floor);
    for (std::size_t i = 0; i < kRing; ++i) {
      const std::size_t j = (i + 1) % kRing;
      const bool side = i == 3 || i == 5, roof = i == 4, under = i == kRing - 1;
      const bool glass = (side && b.glass_before) || (roof && b.screen);
      out.look(glass ? "pane" : under || i == 0 || i == 8 ? "rubber" : paint);
      out.quad(p[i], p[j], q[j], q[i]);
    }
  }
  for (const bool front : {true, false}) {
    const auto ring = ring_of(front ? body.stations.front() : body.stations.back(), body.floor);
    std::vector<Vec3> face(ring.begin(), ring.end());
    if (front) std::reverse(face.begin(), face.end());
    out.look(paint);
    out.face(face);
  }
}

void add_wheel(const Vec3& hub, double radius, double outwards, MeshBuilder& out) {
  const Vec3 in(hub.x, hub.y - outwards * 0.20, hub.z), face(hub.x, hub.y + outwards * 0.012, hub.z);
  out.look("rubber");
  out.tube(in, face, radius, radius, 18);
  // The dark arch about it, a little wider, just proud of the panel.
  out.tube(Vec3(hub.x, hub.y - outwards * 0.25, hub.z + 0.05), Vec3(hub.x, hub.y - outwards * 0.006, hub.z + 0.05),
           radius * 1.12, radius * 1.12, 18);
  out.look("steel_galvanised");
  out.tube(face, Vec3(hub.x, hub.y + outwards * 0.02, hub.z), radius * 0.64, radius * 0.6, 14);
  out.look("rubber");
  for (int i = 0; i < 5; ++i) {
    const portable::SinCos t = portable::sincos(2 * portable::kPi * i / 5);
    const Vec3 at(hub.x + t.cos * radius * 0.38, hub.y + outwards * 0.015, hub.z + t.sin * radius * 0.38);
    out.tube(at, at + Vec3(0, outwards * 0.009, 0), radius * 0.12, radius * 0.12, 6);
  }
}

void add_details(const Body& body, MeshBuilder& out) {
  const Station &front = body.stations[1], &rear = body.stations[body.stations.size() - 2];
  const double f = body.stations.front().x, r = body.stations.back().x;
  out.look("rubber");  // bumpers, grille, sills
  out.box({f - 0.35, -front.half * 0.92, body.floor + 0.02}, {f + 0.03, front.half * 0.92, body.floor + 0.2});
  out.box({r - 0.03, -rear.half * 0.92, body.floor + 0.02}, {r + 0.35, rear.half * 0.92, body.floor + 0.22});
  out.box({f - 0.06, -0.36, front.waist - 0.22}, {f + 0.012, 0.36, front.waist - 0.12});
  out.look("paper");  // plates
  out.box({f, -0.26, body.floor + 0.06}, {f + 0.045, 0.26, body.floor + 0.17});
  out.box({r - 0.045, -0.26, front.waist - 0.16}, {r, 0.26, front.waist - 0.05});
  out.look("steel_galvanised");  // headlamps
  for (const double y : {-0.56, 0.56})
    out.box({f - 0.16, y - 0.14, front.waist - 0.13}, {f - 0.01, y + 0.14, front.waist - 0.02});
  out.look("paint_red");
  for (const double y : {-0.6, 0.6})
    out.box({r - 0.012, y - 0.13, rear.waist - 0.28}, {r + 0.12, y + 0.13, rear.waist - 0.1});
  out.look("rubber");  // mirrors
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (body.stations[3].half + 0.08);
    out.box({body.stations[3].x - 0.35, y - 0.09, body.stations[3].waist + 0.03},
            {body.stations[3].x - 0.22, y + 0.09, body.stations[3].waist + 0.17});
  }
}

}  // namespace

double vehicle_length(int number) { return bodies()[std::size_t(number) / 3].length; }

SurroundingMesh make_vehicle(int number) {
  static const std::array<const char*, 3> kPaints{"car_paint", "paint_light", "paint_red"};
  const Body& body = bodies()[std::size_t(number) / 3];
  SurroundingMesh out;
  for (const bool fine : {true, false}) {
    MeshBuilder builder;
    add_body(body, kPaints[std::size_t(number) % 3], builder);
    if (fine) add_details(body, builder);
    for (const double x : {body.front_axle, body.rear_axle})
      for (const double side : {-1.0, 1.0})
        add_wheel({x, side * (body.stations[5].half * 0.995), body.wheel}, body.wheel, side, builder);
    out.levels.push_back(builder.take_smooth(34));
  }
  out.light_spacing = 0.5;
  return out;
}

}  // namespace rubble
