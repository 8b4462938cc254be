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

struct Speeds {
  double per_piece = 0;      // to settle; 0: not known; unit: s
  double per_megapixel = 0;  // to light, draw and record; likewise; unit: s
};

// One entry for this machine and user: where the cache folder is.
std::string speeds_key() { return CacheKey("run speeds", 1).hex(); }

Speeds read_speeds() {
  Speeds speeds;
  const auto bytes = DiskCache(DiskCache::usual_folder()).find("speeds", speeds_key());
  if (!bytes) return speeds;
  CacheReader reader(*bytes);
  reader.get(speeds);
  return reader.whole() && std::isfinite(speeds.per_piece + speeds.per_megapixel) ? speeds : Speeds{};
}

double mix(double known, double found) { return known > 0 ? 0.5 * (known + found) : found; }

std::string whole(double number) { return std::to_string(std::llround(number)); }

}  // namespace

RunPreview preview_run(RunKind kind, const Scenario& s, const Scenario& pile_mission,
                       const AssetLibrary& assets, const std::string& out) {
  RunPreview preview;
  const PileScenario& pile = pile_mission.pile;
  preview.pieces = double(pile.layers) * pile.pieces_per_layer + double(pile.placed.size());
  if (kind != RunKind::settle) {
    const std::vector<MountedCamera> cameras = all_cameras(s);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const CameraScenario& camera = cameras[i].camera;
      const double frames = size_of_flight(s, i).frames;
      preview.frames += frames;
      preview.megapixels += frames * camera.width * camera.height / 1e6 *
                            (camera.stereo_baseline > 0 ? 2 : 1);
    }
  }
  preview.bytes = estimate_bytes(s, assets, kind == RunKind::settle);
  std::filesystem::path place = std::filesystem::absolute(out);
  std::error_code failed;
  while (place.has_relative_path() && !std::filesystem::exists(place, failed)) place = place.parent_path();
  preview.free = free_bytes(place.string());
  const Speeds speeds = read_speeds();
  const bool settles = kind != RunKind::render;
  const bool known = (!settles || speeds.per_piece > 0) && (preview.frames == 0 || speeds.per_megapixel > 0);
  if (known)
    preview.seconds = (settles ? speeds.per_piece * preview.pieces : 0) +
                      speeds.per_megapixel * preview.megapixels;
  return preview;
}

std::string describe(const RunPreview& preview) {
  std::string text = whole(preview.pieces) + " pieces";
  if (preview.frames > 0) text += ", " + whole(preview.frames) + " frames";
  text += "; at most " + format_bytes(preview.bytes) + " (" + format_bytes(preview.free) + " free)";
  if (!preview.seconds) return text + ", time not known before a first run here";
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
  if (of("settle") > 0 && preview.pieces > 0)
    speeds.per_piece = mix(speeds.per_piece, of("settle") / preview.pieces);
  const double drawn = of("flight") + of("scene") + of("render") + of("record");
  if (preview.megapixels > 0 && drawn > 0)
    speeds.per_megapixel = mix(speeds.per_megapixel, drawn / preview.megapixels);
  CacheWriter writer;
  writer.put(speeds);
  DiskCache(DiskCache::usual_folder()).store("speeds", speeds_key(), writer.bytes());
}

}  // namespace rubble
