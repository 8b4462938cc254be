// What the scores of `rubble eval sfm`, `rubble eval surface` and `rubble eval map` have in common.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command_line/common_options.h"
#include "app/eval/scores/score_table.h"
#include "app/eval/scores/surface_score.h"

namespace rubble {

// The last part of a path, with or without a slash at its end.
std::string name_of(const std::string& path);

// Shares, median distance and completeness; of nothing: empty cells.
void add_surface_cells(const std::optional<SurfaceScore>& score, std::vector<ScoreCell>& cells);

// Before anything takes long. Throws InputError for a file of another kind, and for one that a run recorded.
void check_score_files(const ScoreOutput& output);

// To the files that were asked for, and to standard output.
void print_score(const std::vector<ScoreRow>& rows, const ScoreOutput& output);

}  // namespace rubble
