// A developer's tool: draws the heap from a few views into PPM files and prints times.
//   render_look OUT_PREFIX [PIECES] [SIZE] [FRAMES]
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace {

using namespace rubble;

void write_ppm(const std::string& path, const Frame& frame) {
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << frame.intrinsics.width << " " << frame.intrinsics.height << "\n255\n";
  out.write(reinterpret_cast<const char*>(frame.rgb.data()), std::streamsize(frame.rgb.size()));
}

struct View {
  const char* name;
  Vec3 eye, target;
  bool lamp;
  double fog;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string prefix = argc > 1 ? argv[1] : "/tmp/look";
  const int pieces = argc > 2 ? std::atoi(argv[2]) : 1500;
  const int size = argc > 3 ? std::atoi(argv[3]) : 1024;
  const int frames = argc > 4 ? std::atoi(argv[4]) : 4;
  const View views[] = {{"exterior", {8.5, 3.0, 2.0}, {0, 0, 0.9}, false, 0},
                        {"void_lamp", {1.6, 0.3, 0.6}, {-1.5, 0, 0.5}, true, 0},
                        {"void_dark", {-1.2, 0.2, 0.6}, {2, 0, 0.55}, false, 0},
                        {"void_fog", {-1.2, 0.2, 0.6}, {2, 0, 0.55}, true, 0.35}};
  SoftwareDevice device;
  std::printf("%s\n", device.info().about.c_str());
  for (const View& view : views) {
    Scene scene = testing::make_heap(pieces, 7);
    scene.lamp.on = view.lamp;
    scene.air.fog_density = view.fog;
    RenderOptions options;
    options.threads = 2;
    double last = -1;
    Renderer renderer(device, scene, options, [&](double f) {
      if (f - last > 0.2 || f == 1) std::printf("prepare %.0f%%\n", 100 * f), last = f;
    });
    Frame frame;
    for (int i = 0; i < frames; ++i) {
      const Vec3 step = (view.target - view.eye) * (0.002 * i);
      RenderedView seen = renderer.view({1000000000LL + i * 33000000LL,
                                         testing::pinhole(size, size, 0.6 * size),
                                         testing::look_at(view.eye + step, view.target)});
      seen.rgb();
      const RenderTimes t = seen.times();
      frame = std::move(seen).into_frame(i);
      std::printf("%s %d: visibility %.1f ms (%zu triangles), resolve %.1f ms, read %.1f ms\n",
                  view.name, i, t.visibility.elapsed, t.triangles, t.resolve.elapsed,
                  t.read.elapsed);
    }
    write_ppm(prefix + "_" + view.name + ".ppm", frame);
  }
  return 0;
}
