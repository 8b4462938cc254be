// `rubble pieces`: the pieces of a finished run as a table.
#include <algorithm>
#include <memory>
#include <variant>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/mission/finished_run.h"
#include "app/provenance/earlier_files.h"
#include "app/scene/build_scene.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"
#include "io/base/escaped_text.h"
#include "io/learning/parquet_file.h"
#include "io/mesh/pile_model.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

struct PiecesRequest {
  std::string out;  // --out, .csv or .parquet; empty: CSV to the standard output
};

constexpr const char* kPieceStatusNames[] = {"resting", "moving", "fixed", "lost"};

// Of its surfaces, as the renderer names them: "concrete", "concrete+rebar".
std::string material_of(const SceneMesh& mesh) {
  std::string names;
  for (const std::string& name : mesh.levels.front().surface_names) names += (names.empty() ? "" : "+") + name;
  return names;
}

// What pieces of one type share.
struct PieceTypeColumns {
  std::string asset, material;
  VolumeProperties volume;  // at scale 1
  double density = 0;       // unit: kg/m3
  bool terrain = false;     // it has no mass
};

std::vector<PieceTypeColumns> columns_of_types(const AssetLibrary& assets) {
  std::vector<PieceTypeColumns> columns;
  for (std::size_t i = 0; i < assets.types.size(); ++i) {
    const PieceType& type = assets.types[i];
    PieceTypeColumns& column = columns.emplace_back(PieceTypeColumns{type.name, material_of(*assets.meshes[i]), {}, type.density, type.surface != nullptr});
    if (!column.terrain) column.volume = compile_shape(type, type.name).volume;
  }
  return columns;
}

struct PieceColumn {
  std::string name;
  std::variant<std::vector<std::int64_t>, std::vector<std::string>, std::vector<double>> values{};
};

std::vector<PieceColumn> empty_columns() {
  std::vector<PieceColumn> columns{{"number", std::vector<std::int64_t>{}}};
  for (const char* name : {"name", "asset", "material"}) columns.push_back({name, std::vector<std::string>{}});
  columns.push_back({"layer", std::vector<std::int64_t>{}});
  columns.push_back({"status", std::vector<std::string>{}});
  for (const char* name : {"scale", "density_kg_m3", "volume_m3", "mass_kg", "x", "y", "z", "qw", "qx", "qy", "qz", "centre_x", "centre_y",
                           "centre_z"})
    columns.push_back({name, std::vector<double>{}});
  return columns;
}

// In the order of empty_columns().
void add_row(const PieceState& piece, std::size_t number, const PieceTypeColumns& type, std::vector<PieceColumn>& columns) {
  auto column = columns.begin();
  const auto put = [&](auto value) { std::get<std::vector<decltype(value)>>((column++)->values).push_back(value); };
  put(std::int64_t(number));
  for (const std::string& text : {piece_name(type.asset, number), type.asset, type.material}) put(text);
  put(std::int64_t(piece.layer));
  put(std::string(kPieceStatusNames[int(piece.status)]));
  const double volume = type.volume.volume * piece.scale * piece.scale * piece.scale;
  const Vec3& t = piece.world_from_body.translation;
  const Quat& q = piece.world_from_body.rotation;
  const Vec3 centre = piece.world_from_body * (type.volume.centre_of_mass * piece.scale);
  for (const double value : {piece.scale, type.density, volume, type.density * volume, t.x, t.y, t.z, q.w, q.x, q.y, q.z,
                             centre.x, centre.y, centre.z})
    put(value);
}

std::string cell(std::int64_t value) { return std::to_string(value); }
std::string cell(const std::string& value) { return csv_text(value); }
std::string cell(double value) { return exact_text(value); }

std::string csv_of(const std::vector<PieceColumn>& columns) {
  std::string text;
  for (const PieceColumn& column : columns) text += (text.empty() ? "" : ",") + column.name;
  text += "\n";
  const std::size_t rows = std::visit([](const auto& values) { return values.size(); }, columns.front().values);
  for (std::size_t row = 0; row < rows; ++row)
    for (const PieceColumn& column : columns) {
      text += std::visit([&](const auto& values) { return cell(values[row]); }, column.values);
      text += &column == &columns.back() ? "\n" : ",";
    }
  return text;
}

std::string parquet_of(const std::vector<PieceColumn>& columns) {
  ParquetTable table;
  for (const PieceColumn& column : columns)
    std::visit([&](const auto& values) { table.add(column.name, values); }, column.values);
  return table.encode();
}

bool is_parquet(const std::string& path) {
  const std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  if (path.empty() || ending == ".csv") return false;
  if (ending == ".parquet") return true;
  throw InputError({path, 0, "--out", "the name says no format of tables", "a file that ends with .csv or .parquet",
                    ending.empty() ? "no ending" : ending, ""});
}

ExitCode list_pieces(const FolderRequest& request, const PiecesRequest& to) {
  const bool parquet = is_parquet(to.out);
  if (!to.out.empty()) refuse_recorded_file(to.out, "--out");
  const FinishedRun saved = open_finished_run(request.folder);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  const PileState pile = load_pile_of(saved, assets);
  const std::vector<PieceTypeColumns> types = columns_of_types(assets);
  std::vector<PieceColumn> columns = empty_columns();
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceTypeColumns& type = types[std::size_t(pile.pieces[i].type)];
    if (!type.terrain) add_row(pile.pieces[i], i, type, columns);
  }
  const std::string bytes = parquet ? parquet_of(columns) : csv_of(columns);
  if (to.out.empty())
    print_out("%s", bytes.c_str());
  else
    write_text_file(to.out, bytes);
  return ExitCode::done;
}

Action declare_pieces(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<PiecesRequest>();
  add_folder_options(line, *of);
  line.add("--out", request->out, "Output table, .csv or .parquet").shows_default_text("CSV to the standard output").metavar("FILE");
  return [of, request] { return list_pieces(*of, *request); };
}

}  // namespace

Command pieces_command() {
  return {"", "pieces", "Print the pieces of a finished run as a table: material, mass, scale, pose", declare_pieces};
}

}  // namespace rubble
