// `rubble cutaway`: a picture of a settled pile cut open, its cut faces marked, to scale.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/measures/pile_section.h"
#include "app/mission/finished_run.h"
#include "app/provenance/earlier_files.h"
#include "app/scene/build_scene.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "app/support/run_request.h"
#include "io/image/picture_sheet.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/renderer.h"

namespace rubble {
namespace {

// A picture of the pile, cut open across Y.
struct CutawayRequest {
  std::optional<double> y;  // --y, of the plane; what is in front of it is taken away; unit: m
  int width = 900;    // --width; unit: pixel
  std::string title;  // --title, printed above
  std::string out;    // --out; empty: cutaway.png in the folder of the run
};

constexpr int kOversample = 2;
constexpr double kMargin = 0.5;         // around the pile; unit: m
constexpr double kRoomForPerson = 1.1;  // beside it; unit: m
constexpr double kPerson = 1.75;        // tall; unit: m
constexpr double kLine = 0.014;         // half the width of a cut face's outline; unit: m

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kCut{186, 92, 66}, kOutline{74, 30, 20}, kGround{92, 80, 66}, kMark{20, 44, 92};

// Looks along +Y at the plane, whose points keep their proportions; a little from above.
struct View {
  int width, height;         // unit: pixel
  double x0, z0, per_metre;  // of the lower left corner; pixels per metre on the plane
  Pose world_from_camera;
  Intrinsics intrinsics;

  View(const PileSection& section, double y, int wanted_width) {
    x0 = section.x0 - kMargin;
    z0 = -0.35;
    const double across = section.x1 - section.x0 + 2 * kMargin + kRoomForPerson;
    const double up = std::max(section.top, kPerson) + kMargin - z0;
    width = wanted_width;
    per_metre = width / across;
    height = int(up * per_metre) & ~1;
    const double away = 1.7 * std::max(across, 2 * up), camera_x = x0 + across / 2;
    const double camera_z = std::max(1.6, 0.8 * up);
    world_from_camera = {portable::quat_from_rpy(0, 0, portable::kPi / 2),
                         {camera_x, y - away, camera_z}};
    intrinsics.width = width, intrinsics.height = height;
    intrinsics.fx = intrinsics.fy = per_metre * away;
    intrinsics.cx = (camera_x - x0) * per_metre - 0.5;
    intrinsics.cy = height - (camera_z - z0) * per_metre - 0.5;
  }
  double x_of(int column) const { return x0 + (column + 0.5) / per_metre; }
  double z_of(int row) const { return z0 + (height - row - 0.5) / per_metre; }
};

class Picture {
 public:
  Picture(const View& view, std::vector<std::uint8_t> rgb) : view_(view), rgb_(std::move(rgb)) {}

  void fill_cut(const PileSection& section) {
    for (int row = 0; row < view_.height; ++row) {
      const double z = view_.z_of(row);
      if (z < 0) {  // the ground was cut, too
        for (int c = 0; c < view_.width; ++c) paint(c, row, hatched(c, row) ? kOutline : kGround);
        continue;
      }
      for (const CutFace& face : section.faces) {
        const std::vector<double> x = find_insides(face, z);
        for (std::size_t i = 0; i + 1 < x.size(); i += 2)
          for (int c = first_column(x[i]); c < first_column(x[i + 1]); ++c) paint(c, row, kCut);
      }
    }
    for (const CutFace& face : section.faces)
      for (const CutSegment& s : face.segments) draw_line(s);
  }

  // A person standing at x, and a metre of scale at their feet.
  void draw_person(double x) {
    for (int row = 0; row < view_.height; ++row) {
      for (int c = 0; c < view_.width; ++c) {
        const double dx = view_.x_of(c) - x, z = view_.z_of(row);
        const bool scale = std::fabs(dx) <= 0.5 && z < -0.12 && z > -0.20;
        if (is_person(dx, z) || scale)
          paint(c, row, scale && dx > 0 ? Colour{240, 240, 240} : kMark);
      }
    }
  }

  RgbImage shrunk() const {
    RgbImage image{view_.width / kOversample, view_.height / kOversample, {}};
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        for (int channel = 0; channel < 3; ++channel) {
          int sum = 0;
          for (int v = 0; v < kOversample; ++v)
            for (int u = 0; u < kOversample; ++u)
              sum += rgb_[at(x * kOversample + u, y * kOversample + v) + std::size_t(channel)];
          image.rgb.push_back(std::uint8_t(sum / (kOversample * kOversample)));
        }
      }
    }
    return image;
  }

 private:
  std::size_t at(int column, int row) const {
    return 3 * (std::size_t(row) * std::size_t(view_.width) + std::size_t(column));
  }
  void paint(int column, int row, const Colour& colour) {
    if (column < 0 || row < 0 || column >= view_.width || row >= view_.height) return;
    std::copy(colour.begin(), colour.end(), rgb_.begin() + std::ptrdiff_t(at(column, row)));
  }
  int first_column(double x) const {
    return std::clamp(int(std::ceil((x - view_.x0) * view_.per_metre - 0.5)), 0, view_.width);
  }
  static bool hatched(int column, int row) { return (column + row) % 24 < 3; }

  void draw_line(const CutSegment& s) {
    const double length = quick::hypot(s.x1 - s.x0, s.z1 - s.z0);
    const int steps = 1 + int(length * view_.per_metre),
              half = std::max(1, int(kLine * view_.per_metre));
    for (int i = 0; i <= steps; ++i) {
      const double t = double(i) / steps;
      const int column = int((s.x0 + (s.x1 - s.x0) * t - view_.x0) * view_.per_metre);
      const int row =
          view_.height - 1 - int((s.z0 + (s.z1 - s.z0) * t - view_.z0) * view_.per_metre);
      for (int v = -half / 2; v <= half / 2; ++v)
        for (int u = -half / 2; u <= half / 2; ++u) paint(column + u, row + v, kOutline);
    }
  }

  static bool near_bone(double x, double z, double xa, double za, double xb, double zb, double r) {
    const double ux = xb - xa, uz = zb - za;
    const double t = std::clamp(((x - xa) * ux + (z - za) * uz) / (ux * ux + uz * uz), 0.0, 1.0);
    return quick::hypot(x - xa - t * ux, z - za - t * uz) <= r;
  }
  static bool is_person(double x, double z) {
    x = std::fabs(x);  // seen from the front
    return quick::hypot(x, z - 1.63) <= 0.12 || near_bone(x, z, 0, 1.40, 0, 0.98, 0.14) ||
           near_bone(x, z, 0.19, 1.38, 0.27, 0.82, 0.05) ||
           near_bone(x, z, 0.09, 0.95, 0.12, 0.07, 0.07);
  }

  const View& view_;
  std::vector<std::uint8_t> rgb_;
};

// The light comes with the view, from its upper left, so that it falls through the cut.
void light_up(Scene& scene) {
  scene.light = LightSpec{};
  scene.light.rpy_deg = {0, 30, 68};
  scene.light.intensity = 75;
  scene.more_lights.clear();
  scene.lamp.on = false;
  scene.air = AirSpec{};
  scene.wetness = 0;
}

// Half of the pieces have their origins on either side; unit: m
double find_middle(const PileState& pile) {
  std::vector<double> places;
  for (const PieceState& piece : pile.pieces)
    if (piece.status != PieceStatus::lost) places.push_back(piece.world_from_body.translation.y);
  if (places.empty()) return 0;
  std::nth_element(places.begin(), places.begin() + std::ptrdiff_t(places.size() / 2), places.end());
  return places[places.size() / 2];
}

ExitCode draw_cutaway(const FolderRequest& request, const CutawayRequest& cutaway) {
  const std::string path = cutaway.out.empty() ? request.folder + "/cutaway.png" : cutaway.out;
  check_picture_name(path);
  refuse_recorded_file(path, "--out");
  const FinishedRun saved = open_finished_run(request.folder);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  const PileState pile = load_pile_of(saved);
  double y = cutaway.y.value_or(0);
  PileSection section = cut_pile(build_scene(Scenario{}, assets, pile), y);
  if (section.faces.empty() && !cutaway.y) y = find_middle(pile), section = cut_pile(build_scene(Scenario{}, assets, pile), y);
  if (section.faces.empty())
    throw InputError({"", 0, "--y", "the plane cuts no piece", "a plane through the pile", plain_text(y), ""});
  light_up(section.scene);
  const View view(section, y, cutaway.width * kOversample);
  RenderOptions options;
  options.threads = RunContext(request.options).threads();
  const std::unique_ptr<Device> device = open_device(request.options.device, options.threads);
  Renderer renderer(*device, section.scene, options);
  Frame frame;
  for (int i = 0; i < 3; ++i)
    frame = renderer.render(view.world_from_camera, view.intrinsics, i, 1000000000LL * (i + 1));
  Picture picture(view, std::move(frame.rgb));
  picture.fill_cut(section);
  picture.draw_person(section.x1 + kMargin / 2 + kRoomForPerson / 2);
  const bool street = stated_scenario(saved.manifest.provenance).surroundings.on();
  char note[160];
  std::snprintf(
      note, sizeof note,
      "cut at y = %.2f m; red: what the cut went through; the person is %.2f m tall, the bar 1 m%s",
      y, kPerson, street ? "; without the surroundings" : "");
  write_picture_sheet(path, cutaway.title, {{picture.shrunk(), "", note}}, 1);
  print_out("%s\n", path.c_str());
  return ExitCode::done;
}

Action declare_cutaway(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<CutawayRequest>();
  add_folder_options(line, *of);
  add_device_option(line, of->options.device);
  add_threads_option(line, of->options.threads);
  line.add("--y", request->y, "Position of the section plane on the Y axis")
      .shows_default_text("0; where that cuts nothing, the middle of the pieces")
      .metavar("METRES")
      .within(-1000.0, 1000.0);
  line.add("--width", request->width, "Width of the picture, in pixels")
      .shows_default()
      .between(200, 4000);
  line.add("--title", request->title, "Title above the picture");
  line.add("--out", request->out, "Output picture, .png or .jpg")
      .shows_default_text("FOLDER/cutaway.png")
      .metavar("FILE");
  return [of, request] { return draw_cutaway(*of, *request); };
}

}  // namespace

Command cutaway_command() {
  return {"", "cutaway", "Draw a section of the pile of a run, to scale", declare_cutaway};
}

}  // namespace rubble
