// render_bench: how fast frames of the standard views come, and where the time goes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "app/support/drawing_device.h"
#include "bench/calibration.h"
#include "bench/process_times.h"
#include "bench/program.h"
#include "bench/render_views.h"
#include "kernel/base/system/thread_count.h"
#include "kernel/base/system/disk_cache.h"
#include "render/renderer.h"

namespace rubble {
namespace {

using Clock = std::chrono::steady_clock;

struct Request {
  std::vector<std::string> views;
  std::vector<int> sizes = {1024, 512};
  int frames = 30;
  int threads = 0;
  std::string device;
  bool csv = false, split = false;
  std::string pictures;
  int fines = 0;
  bool surroundings = false;
  bool draft = false;
};

// What goes on from view to view.
struct Session {
  Calibration machine;
  Clock::time_point start = Clock::now();  // of the program
  double first_frame_s = 0;                // after it
  std::int64_t now_ns = 0;                 // in the scene
};

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double processor_ms() { return double(std::clock()) * 1e3 / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// What was measured of each frame; unit: ms, but for the triangles.
struct Series {
  struct Pass {
    std::vector<double> elapsed, processor;

    void add(const PassTime& t) { elapsed.push_back(t.elapsed), processor.push_back(t.processor); }
  };
  Pass total, visibility, resolve, read, finish;
  std::vector<double> triangles;
  std::vector<double> waits, given, taken;  // as DeviceTraffic; the latter two in MB

  void add(const PassTime& all, const RenderTimes& t, const DeviceTraffic& before, const DeviceTraffic& after) {
    total.add(all), visibility.add(t.visibility), resolve.add(t.resolve);
    read.add(t.read), finish.add(t.finish), triangles.push_back(double(t.triangles));
    waits.push_back(double(after.waits - before.waits));
    given.push_back(1e-6 * double(after.given - before.given)), taken.push_back(1e-6 * double(after.taken - before.taken));
  }
};

// Elapsed and processor time.
std::string both(const Series::Pass& pass) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f/%.1f", median(pass.elapsed), median(pass.processor));
  return text;
}

void print(const Request& request, const char* view, int size, const Series& s,
           const Session& session) {
  const double middle = median(s.total.elapsed);
  const double least = *std::min_element(s.total.elapsed.begin(), s.total.elapsed.end());
  if (request.csv) {
    std::printf("%s,%d,%zu,%.2f,%.2f,%.2f", view, size, s.total.elapsed.size(), middle, least,
                1000 / middle);
    if (request.split)
      std::printf(",%.2f,%s,%s,%s,%s,%.0f,%.0f,%.2f,%.2f,%.2f,%.0f,%s", median(s.total.processor),
                  both(s.visibility).c_str(), both(s.resolve).c_str(), both(s.read).c_str(),
                  both(s.finish).c_str(), median(s.triangles), median(s.waits), median(s.given), median(s.taken),
                  session.first_frame_s, read_peak_rss(), calibration_csv(session.machine).c_str());
    std::printf("\n");
  } else {
    std::printf("%-13s %5d %8.1f %8.1f %8.1f %7.1f %13s %13s %9s %11s %10.0f\n", view, size, middle,
                least, median(s.total.processor), 1000 / middle, both(s.visibility).c_str(),
                both(s.resolve).c_str(), both(s.read).c_str(), both(s.finish).c_str(),
                median(s.triangles));
  }
  std::fflush(stdout);
}

void write_ppm(const std::string& path, const Frame& frame) {
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << frame.intrinsics.width << " " << frame.intrinsics.height << "\n255\n";
  out.write(reinterpret_cast<const char*>(frame.rgb.data()), std::streamsize(frame.rgb.size()));
}

Series fly(Device& device, Renderer& renderer, const BenchView& view, int size, const Request& request,
           Session& session) {
  constexpr int kWarm = 3;  // exposure, history of what shows, pages of memory
  const Intrinsics camera = bench_camera(size);
  const std::vector<Pose> poses = view.path(request.frames + kWarm);
  Series series;
  std::optional<RenderedView> ahead;
  // Seconds pass before the first that counts, so that the exposure is that of this view.
  const auto step_to = [](std::size_t i) { return std::int64_t(i < kWarm ? 2000000000 : 33333333); };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto start = Clock::now();
    const double processor_start = processor_ms();
    const DeviceTraffic before = device.traffic();
    session.now_ns += step_to(i);
    // As a Camera does: a device draws the next while this one is read.
    RenderedView seen = ahead ? std::move(*ahead) : renderer.view({session.now_ns, camera, poses[i]});
    seen.begin();
    ahead.reset();
    if (renderer.runs_ahead()) {  // behind the last as well, so that it costs what the others do
      ahead = renderer.view({session.now_ns + step_to(i + 1), camera, poses[std::min(i + 1, poses.size() - 1)]});
      ahead->begin();
    }
    seen.rgb(), seen.depth();
    const RenderTimes times = seen.times();
    const Frame frame = std::move(seen).into_frame(int(i));
    if (session.first_frame_s == 0) session.first_frame_s = since(session.start) / 1000;
    const PassTime all{since(start), processor_ms() - processor_start};
    if (i >= kWarm) series.add(all, times, before, device.traffic());
    if (i + 1 == poses.size() && !request.pictures.empty())
      write_ppm(request.pictures + view.name + "_" + std::to_string(size) + ".ppm", frame);
  }
  return series;
}

void print_head(const Request& request, const Device& device, double load_ms, double ready_ms) {
  if (request.csv) {
    std::printf("view,size,frames,median_ms,min_ms,fps%s\n",
                request.split ? ",cpu_ms,visibility_ms,resolve_ms,read_ms,finish_ms,triangles,waits,given_mb,taken_mb,"
                                "first_frame_s,peak_rss_mib,calibration_1_ms,calibration_2_ms"
                              : "");
    return;
  }
  std::printf("%s: %s; scene loaded in %.2f s, lit in %.2f s\n", device.info().name.c_str(),
              device.info().about.c_str(), load_ms / 1000, ready_ms / 1000);
  std::printf("%-13s %5s %8s %8s %8s %7s %13s %13s %9s %11s %10s\n", "view", "size", "median",
              "min", "CPU", "frame/s", "visibility", "resolve", "read", "finish", "triangles");
}

ExitCode bench(const Request& request) {
  namespace fs = std::filesystem;
  const int threads =
      request.threads > 0 ? request.threads : default_thread_count();
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const Calibration machine = calibrate();  // before the clock of the program starts
  Session session;
  session.machine = machine;
  const Scene scene = load_bench_scene((program.parent_path() / "render_views.lua").string(),
                                       threads, [](const char* line) {
                                         std::fprintf(stderr, "render_bench: %s\n", line);
                                       }, request.fines, request.surroundings);
  const double load_ms = since(session.start);
  const std::unique_ptr<Device> device = open_device(request.device, threads);
  RenderOptions options;
  if (request.draft) options.colour.quality = RenderQuality::draft;
  options.threads = threads;
  options.cache_folder = DiskCache::usual_folder();
  const auto light = Clock::now();
  Renderer renderer(*device, scene, options);
  print_head(request, *device, load_ms, since(light));
  for (const BenchView& view : bench_views()) {
    const auto& wanted = request.views;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), view.name) == wanted.end())
      continue;
    for (const int size : request.sizes)
      print(request, view.name, size, fly(*device, renderer, view, size, request, session), session);
  }
  if (!request.csv)
    std::printf("first frame %.2f s after the start; %.0f MiB of memory at most\n%s",
                session.first_frame_s, read_peak_rss(), calibration_text(machine).c_str());
  else if (!request.split)
    std::fputs(calibration_text(machine).c_str(), stderr);
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Draws the standard views of a settled pile of 3,750 pieces, colour and depth, read-back "
      "included, and prints times in ms: the median and the least frame, and the medians by pass."};
  Request request;
  std::vector<std::string> names;
  for (const BenchView& view : bench_views()) names.push_back(view.name);
  app.add_option("--view", request.views, "Only this view; may be repeated")
      ->check(CLI::IsMember(names));
  app.add_option("--size", request.sizes, "Side of the square image; may be repeated")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.add_option("--frames", request.frames, "Frames of each view")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--threads", request.threads, "0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--device", request.device, "What draws: " + describe_devices() + "; default: as $RUBBLE_DEVICE, else software")
      ->check([](const std::string& text) { return read_device(text) ? std::string() : "expected " + describe_devices(); });
  app.add_option("--pictures", request.pictures, "Also write each view's last frame, PREFIXview.ppm");
  app.add_option("--fines", request.fines, "Loose pieces that are strewn over the pile first (docs/explanation/fines.md)")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  app.add_flag("--surroundings", request.surroundings, "With a street about the pile (docs/explanation/surroundings.md)");
  app.add_flag("--draft", request.draft, "With camera.quality = draft");
  app.add_flag("--csv", request.csv, "Lines view,size,frames,median_ms,min_ms,fps");
  app.add_flag("--split", request.split,
               "With --csv also processor time, each pass (elapsed/processor), how often a frame waits for the device, what it "
               "hands over and takes back, the first frame after the start (s), peak memory and the calibration of the machine");
  return parse_and_run(app, argc, argv, [&] { return bench(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("render_bench", [=] { return rubble::run(argc, argv); });
}
