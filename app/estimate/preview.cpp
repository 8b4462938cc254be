#include "app/estimate/preview.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "app/formats/recorded_size.h"
#include "app/estimate/disk_estimate.h"
#include "kernel/base/system/disk_cache.h"

namespace rubble {
namespace {

constexpr double kMostTimesLarger = 20;  // than earlier runs together, for them to tell of it; unit: 1

// Of earlier runs together, so that a small one, most of which is its beginning, says little about a large one.
struct Effort {
  double seconds = 0, amount = 0;

  bool tells_of(double much) const { return much == 0 || (amount > 0 && much <= kMostTimesLarger * amount); }
  double expect(double much) const { return much == 0 ? 0 : seconds / amount * much; }
  void note(double took, double much) {
    if (!(took > 0) || !(much > 0)) return;
    seconds = 0.5 * seconds + took, amount = 0.5 * amount + much;
  }
};

struct Speeds {
  Effort settling, collapsing;  // by RunPreview::piled
  Effort driving;               // by simulated seconds of a robot
  Effort lighting;              // by runs that draw: paths, light, shadows
  Effort drawing, tracing;      // by megapixels
};

// One entry for this machine and user: where the cache folder is.
std::string speeds_key() { return CacheKey("run speeds", 3).hex(); }

Speeds read_speeds() {
  Speeds speeds;
  const auto bytes = DiskCache(DiskCache::usual_folder()).find("speeds", speeds_key());
  if (!bytes) return speeds;
  CacheReader reader(*bytes);
  reader.get(speeds);
  return reader.whole() ? speeds : Speeds{};
}

// What of a run takes time.
struct Parts {
  double piled, robot_seconds, runs, megapixels, traced_megapixels;
};

Parts parts_of(const RunPreview& preview, bool settles) {
  return {settles ? preview.piled : 0, preview.robot_seconds, preview.frames > 0 ? 1.0 : 0.0, preview.megapixels,
          preview.traced_megapixels};
}

std::string whole(double number) { return std::to_string(std::llround(number)); }

}  // namespace

RunPreview preview_run(RunKind kind, const Scenario& s, const AssetLibrary& assets, const std::string& out) {
  RunPreview preview;
  const PileScenario& pile = s.pile;
  const double first = double(pile.placed.size()) + count_building_pieces(pile, assets), layers = pile.layers;
  preview.pieces = first + layers * pile.pieces_per_layer;
  preview.piled = first * (1 + layers) + 0.5 * layers * (layers + 1) * pile.pieces_per_layer;
  if (kind != RunKind::settle) {
    for (std::size_t i = 0; i < s.cameras.size(); ++i) {
      const CameraScenario& camera = s.cameras[i].camera;
      const double frames = size_of_flight(s, i).frames;
      preview.frames += frames;
      const int samples = camera.sensor.pixel_samples;
      const double drawn = frames * camera.width * camera.height / 1e6 * samples * samples * (camera.stereo_baseline > 0 ? 2 : 1);
      if (camera.colour.quality == RenderQuality::reference)
        preview.traced_megapixels += drawn * camera.colour.samples;
      else
        preview.megapixels += drawn;
    }
    const double rate = s.cameras.front().rate_hz.value_or(s.trajectory.rate_hz);
    preview.robot_seconds = double(s.robots.size()) * size_of_flight(s, 0).frames / rate;
  }
  preview.collapses = pile.building.given();
  preview.bytes = estimate_bytes(s, assets, kind == RunKind::settle);
  std::filesystem::path place = std::filesystem::absolute(out);
  std::error_code failed;
  while (place.has_relative_path() && !std::filesystem::exists(place, failed)) place = place.parent_path();
  preview.free = free_bytes(place.string());
  const Speeds speeds = read_speeds();
  const Parts parts = parts_of(preview, kind != RunKind::render);
  const Effort& piling = preview.collapses ? speeds.collapsing : speeds.settling;
  if (piling.tells_of(parts.piled) && speeds.driving.tells_of(parts.robot_seconds) &&
      speeds.lighting.tells_of(parts.runs) && speeds.drawing.tells_of(parts.megapixels) &&
      speeds.tracing.tells_of(parts.traced_megapixels))
    preview.seconds = piling.expect(parts.piled) + speeds.driving.expect(parts.robot_seconds) +
                      speeds.lighting.expect(parts.runs) + speeds.drawing.expect(parts.megapixels) +
                      speeds.tracing.expect(parts.traced_megapixels);
  return preview;
}

std::string describe(const RunPreview& preview) {
  std::string text = whole(preview.pieces) + " pieces";
  if (preview.frames > 0) text += ", " + whole(preview.frames) + " frames";
  text += "; at most " + format_bytes(preview.bytes) + " (" + format_bytes(preview.free) + " free)";
  if (!preview.seconds) return text + ", time not known: nothing like it was run here yet";
  const double seconds = *preview.seconds;
  const std::string time = seconds < 100 ? whole(std::max(1.0, seconds)) + " s"
                           : seconds < 6000 ? whole(seconds / 60) + " minutes"
                                            : whole(seconds / 3600) + " hours";
  return text + ", about " + time + " by earlier runs here";
}

std::string describe_files(RunKind kind, const Scenario& mission, const AssetLibrary& assets) {
  std::vector<std::pair<std::uint64_t, std::string>> files;
  for (const auto& [name, bytes] : estimate_files(mission, assets, kind == RunKind::settle))
    files.emplace_back(bytes, name);
  std::sort(files.rbegin(), files.rend());
  std::string text;
  for (const auto& [bytes, name] : files) {
    char line[160];
    std::snprintf(line, sizeof line, "%-24s at most %s\n", name.c_str(), format_bytes(bytes).c_str());
    text += line;
  }
  return text;
}

void note_speed(const RunPreview& preview, const Progress& progress) {
  const auto& times = progress.wall_seconds();
  const auto of = [&](const char* stage) {
    const auto found = times.find(stage);
    return found == times.end() ? 0.0 : found->second;
  };
  Speeds speeds = read_speeds();
  const Parts parts = parts_of(preview, of("settle") > 0);
  (preview.collapses ? speeds.collapsing : speeds.settling).note(of("settle"), parts.piled);
  speeds.driving.note(of("robots"), parts.robot_seconds);
  speeds.lighting.note(of("flight") + of("scene"), parts.runs);
  // Of a run that has both nobody knows which took how long.
  const double coloured = of("render") + of("record");
  if (parts.traced_megapixels == 0) speeds.drawing.note(coloured, parts.megapixels);
  if (parts.megapixels == 0) speeds.tracing.note(coloured, parts.traced_megapixels);
  CacheWriter writer;
  writer.put(speeds);
  DiskCache(DiskCache::usual_folder()).store("speeds", speeds_key(), writer.bytes());
}

}  // namespace rubble
