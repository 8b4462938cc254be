// Grids of numbers that a script may read: pictures and elevation models. Kept as plain text, so that what
// a mission was made from stays readable in its manifest.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rubble {

struct DataGrid {
  int columns = 0, rows = 0;   // unit: grid point
  std::vector<double> values;  // row by row from the top; NaN: the file has no value there
  // Of grey levels, what white is; values are from 0 to this. 0: values are heights, in m.
  double white = 0;
  double spacing = 0;          // of grid points, if the file says; 0: it does not; unit: m
  double east = 0, north = 0;  // of the lower left corner in the file's map; unit: m
  bool degrees = false;        // spacing, east and north are degrees
  bool colour = false;         // of a colour picture, whose brightness was taken
  int block = 1;               // points of the file, a side, over which each value is averaged
  int cut_columns = 0, cut_rows = 0;  // of the file, at its edges, that fill no whole block and are left out

  bool metric() const { return white == 0; }
};

inline constexpr int kUsualSide = 256, kLargestSide = 900;  // of what is kept; unit: grid point

// Whether read_data_grid() is for it: a picture of any kind, a plain PGM or an ESRI ASCII grid.
bool is_data_grid(std::string_view bytes);

// Throws std::runtime_error that says why it cannot be, after the file's name. kept: a text of data_grid_text(), whose
// cellsize is 0 where the file had no spacing.
DataGrid read_data_grid(std::string_view bytes, bool kept = false);

// Averaged over square blocks, so that no side has more points than `side`. Grey levels stay integers. Whole blocks in the
// middle of the grid count, and what is left over at its edges does not; a way with less than two whole blocks keeps
// incomplete ones, which hang over on both sides. A block with a point without a value has none.
DataGrid thinned(DataGrid grid, int side);

// A plain PGM ("P2") of grey levels, an ESRI ASCII grid of heights. read_data_grid() reads it back.
std::string data_grid_text(const DataGrid& grid);

}  // namespace rubble
