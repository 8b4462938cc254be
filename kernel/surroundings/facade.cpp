#include "kernel/surroundings/facade.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr double kReveal = 0.14;  // unit: m
constexpr double kFrame = 0.065;  // width of a window's frame; unit: m

bool holds(const Opening& o, double x, double z) { return x > o.left && x < o.right && z > o.low && z < o.high; }

// A face looking to -y.
void sheet(MeshBuilder& out, double x0, double x1, double z0, double z1, double y) {
  out.quad({x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
}

void add_reveal(const Opening& o, double depth, MeshBuilder& out) {
  const double l = o.left, r = o.right, b = o.low, t = o.high;
  out.quad({l, 0, b}, {l, depth, b}, {l, depth, t}, {l, 0, t});
  out.quad({r, depth, b}, {r, 0, b}, {r, 0, t}, {r, depth, t});
  out.quad({l, 0, b}, {r, 0, b}, {r, depth, b}, {l, depth, b});
  out.quad({l, depth, t}, {r, depth, t}, {r, 0, t}, {l, 0, t});
}

void add_frame(const Opening& o, int leaves, double y, MeshBuilder& out) {
  sheet(out, o.left, o.right, o.low, o.low + kFrame, y);
  sheet(out, o.left, o.right, o.high - kFrame, o.high, y);
  sheet(out, o.left, o.left + kFrame, o.low + kFrame, o.high - kFrame, y);
  sheet(out, o.right - kFrame, o.right, o.low + kFrame, o.high - kFrame, y);
  for (int i = 1; i < leaves; ++i) {
    const double x = o.left + (o.right - o.left) * i / leaves;
    sheet(out, x - 0.045, x + 0.045, o.low + kFrame, o.high - kFrame, y - 0.005);
  }
}

void add_glazing(const Opening& o, const WallLooks& looks, MeshBuilder& out) {
  out.look(o.lit ? "window_lit" : "pane");
  sheet(out, o.left, o.right, o.low, o.high, kReveal + 0.03);
  const double drop = o.blind * (o.high - o.low);
  if (drop > 0.05) {
    out.look("fabric");
    sheet(out, o.left, o.right, o.high - drop, o.high, kReveal + 0.015);
  }
  if (o.curtain && !o.lit) {
    const double part = 0.24 * (o.right - o.left);
    out.look("fabric");
    sheet(out, o.left, o.left + part, o.low, o.high, kReveal + 0.024);
    sheet(out, o.right - part, o.right, o.low, o.high, kReveal + 0.024);
  }
  out.look(looks.frame);
  add_frame(o, o.leaves, kReveal, out);
}

void add_window(const Opening& o, const WallLooks& looks, MeshBuilder& out) {
  out.look(o.low < looks.ground_top ? looks.ground : looks.upper);
  add_reveal(o, kReveal + 0.03, out);
  add_glazing(o, looks, out);
  if (o.balcony) return;
  out.look("concrete_cast");
  out.box({o.left - 0.06, -0.055, o.low - 0.045}, {o.right + 0.06, 0.02, o.low + 0.004});
}

void add_door(const Opening& o, const WallLooks& looks, MeshBuilder& out) {
  constexpr double kDeep = 0.28;
  out.look(looks.ground);
  add_reveal(o, kDeep, out);
  const double head = o.high - 0.42;
  out.look(looks.door);
  sheet(out, o.left, o.right, o.low, head, kDeep);
  for (int i = 0; i < o.leaves; ++i) {  // panels
    const double w = (o.right - o.left) / o.leaves, x = o.left + w * i;
    for (const double part : {0.08, 0.52})
      out.box({x + 0.13, kDeep - 0.025, o.low + part * (head - o.low)},
              {x + w - 0.13, kDeep, o.low + (part + 0.4) * (head - o.low)});
  }
  out.look(o.lit ? "window_lit" : "pane");
  sheet(out, o.left, o.right, head, o.high, kDeep);
  out.look(looks.door);
  sheet(out, o.left, o.right, head - 0.04, head + 0.05, kDeep - 0.02);
  out.look("concrete_cast");
  out.box({o.left - 0.15, -0.32, -0.3}, {o.right + 0.15, 0.0, o.low});
}

void add_shop(const Opening& o, const WallLooks& looks, MeshBuilder& out) {
  out.look(looks.ground);
  add_reveal(o, 0.2, out);
  out.look(o.lit ? "window_lit" : "pane");
  sheet(out, o.left, o.right, o.low, o.high, 0.2);
  out.look(looks.door);
  add_frame(o, o.leaves, 0.17, out);
  sheet(out, o.left, o.right, o.low, o.low + 0.35, 0.16);
  out.box({o.left - 0.1, -0.09, o.high + 0.12}, {o.right + 0.1, 0.02, o.high + 0.62});
}

void add_bars(double l, double r, double y0, double y1, double z, MeshBuilder& out) {
  const auto bar = [&](double x, double y) { out.box({x - 0.008, y - 0.008, z}, {x + 0.008, y + 0.008, z + 0.98}); };
  const int n = std::max(2, int((r - l) / 0.13)), side = std::max(2, int((y1 - y0) / 0.13));
  for (int i = 0; i <= n; ++i) bar(l + (r - l) * i / n, y0);
  for (int i = 1; i < side; ++i) bar(l, y0 + (y1 - y0) * i / side), bar(r, y0 + (y1 - y0) * i / side);
  out.box({l - 0.025, y0 - 0.025, z + 0.98}, {r + 0.025, y0 + 0.025, z + 1.02});
  out.box({l - 0.025, y0 + 0.025, z + 0.98}, {l + 0.025, y1, z + 1.02});
  out.box({r - 0.025, y0 + 0.025, z + 0.98}, {r + 0.025, y1, z + 1.02});
}

void add_balcony(const Opening& o, MeshBuilder& out) {
  constexpr double kOut = 1.25;
  const double l = o.left - 0.65, r = o.right + 0.65, z = o.low - 0.03;
  out.look("concrete_cast");
  out.box({l, -kOut, z - 0.16}, {r, 0, z});
  if (o.balcony == 1) {
    out.look("steel_galvanised");
    return add_bars(l + 0.04, r - 0.04, -kOut + 0.04, 0, z, out);
  }
  out.look("render");
  out.box({l, -kOut, z}, {r, -kOut + 0.1, z + 1.0});
  out.box({l, -kOut + 0.1, z}, {l + 0.1, 0, z + 1.0});
  out.box({r - 0.1, -kOut + 0.1, z}, {r, 0, z + 1.0});
}

}  // namespace

void add_wall(const Facade& facade, const std::vector<double>& heights, const WallLooks& looks, MeshBuilder& out) {
  std::vector<double> xs{0, facade.width};
  for (const Opening& o : facade.openings) xs.push_back(o.left), xs.push_back(o.right);
  std::sort(xs.begin(), xs.end());
  xs.erase(std::unique(xs.begin(), xs.end()), xs.end());
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
      const double x = (xs[i] + xs[i + 1]) / 2, z = (heights[k] + heights[k + 1]) / 2;
      const bool hole = std::any_of(facade.openings.begin(), facade.openings.end(),
                                    [&](const Opening& o) { return holds(o, x, z); });
      if (hole) continue;
      out.look(z < looks.ground_top ? looks.ground : looks.upper);
      sheet(out, xs[i], xs[i + 1], heights[k], heights[k + 1], 0);
    }
}

void add_openings(const Facade& facade, const WallLooks& looks, MeshBuilder& out) {
  for (const Opening& o : facade.openings) {
    if (o.kind == Opening::Kind::window) add_window(o, looks, out);
    if (o.kind == Opening::Kind::door) add_door(o, looks, out);
    if (o.kind == Opening::Kind::shop) add_shop(o, looks, out);
    if (o.balcony) add_balcony(o, out);
  }
}

void add_panes(const Facade& facade, MeshBuilder& out) {
  for (const Opening& o : facade.openings) {
    out.look(o.kind == Opening::Kind::door ? "timber" : o.lit ? "window_lit" : "pane");
    sheet(out, o.left + 0.05, o.right - 0.05, o.low + 0.05, o.high - 0.05, -0.02);
    if (!o.balcony) continue;
    out.look("drywall");
    out.box({o.left - 0.65, -1.25, o.low - 0.2}, {o.right + 0.65, 0, o.low + (o.balcony == 2 ? 1.0 : 0.1)});
  }
}

}  // namespace rubble
