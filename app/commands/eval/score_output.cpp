#include "app/commands/eval/score_output.h"

#include <filesystem>

#include "app/provenance/earlier_files.h"
#include "app/support/print.h"

namespace rubble {

std::string name_of(const std::string& folder) {
  const auto path = std::filesystem::path(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void add_surface_cells(const std::optional<SurfaceScore>& s, std::vector<ScoreCell>& cells) {
  const auto percent = [&](double SurfaceScore::*share) {
    return s ? std::optional<double>(100 * (*s).*share) : std::nullopt;
  };
  cells.push_back({"within_1cm_percent", "within 1 cm of the surface, %",
                   percent(&SurfaceScore::within_1cm), 1});
  cells.push_back({"within_2cm_percent", "within 2 cm, %", percent(&SurfaceScore::within_2cm), 1});
  cells.push_back({"within_5cm_percent", "within 5 cm, %", percent(&SurfaceScore::within_5cm), 1});
  cells.push_back({"median_distance_m", "median distance, m",
                   s ? std::optional<double>(s->median) : std::nullopt, 4});
  cells.push_back({"completeness_5cm_percent", "visible surface covered within 5 cm, %",
                   percent(&SurfaceScore::completeness_5cm), 1});
}

void check_score_files(const ScoreOutput& output) {
  for (const std::string& path : output.files) {
    check_score_file(path);
    refuse_recorded_file(path, "--out");
  }
}

void print_score(const std::vector<ScoreRow>& rows, const ScoreOutput& output) {
  for (const std::string& path : output.files) write_score_file(path, rows);
  print_result(output.json ? score_json(rows) : score_text(rows), output.json);
}

}  // namespace rubble
