// `rubble export`: the pile of a finished run in other programs' formats.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/build_scene.h"
#include "app/pipeline/finished_run.h"
#include "app/support/progress.h"
#include "io/base/atomic_file.h"
#include "io/mesh/pile_export.h"

namespace rubble {
namespace {

// Into which formats a pile goes, and where to.
struct ExportRequest {
  std::vector<std::string> formats;  // --format, of export_formats(); empty: all
  std::string out;                   // --out; empty: `export` in the folder of the run
  bool force = false;                // --force
};

// "stl, ply, obj, glb or sdf".
std::string join_formats() {
  std::string text;
  const std::vector<std::string> known = export_formats();
  for (std::size_t i = 0; i < known.size(); ++i)
    text += (i == 0 ? "" : i + 1 == known.size() ? " or " : ", ") + known[i];
  return text;
}

// Every format asked for, once, or all of them. Throws InputError for an unknown one.
std::vector<std::string> choose_formats(const std::vector<std::string>& asked) {
  const std::vector<std::string> known = export_formats();
  if (asked.empty()) return known;
  std::vector<std::string> chosen;
  for (const std::string& format : asked) {
    if (std::find(known.begin(), known.end(), format) == known.end())
      throw InputError({"", 0, "--format", "unknown export format",
                        join_formats(), "`" + format + "`", ""});
    if (std::find(chosen.begin(), chosen.end(), format) == chosen.end()) chosen.push_back(format);
  }
  return chosen;
}

// The folder of an earlier `sdf` is ours to replace.
void prepare(const std::string& out, bool force) {
  prepare_output_folder(out, force, {"pile.stl", "pile.ply", "pile.obj", "pile.mtl", "pile.glb"});
  std::error_code error;
  if (force) std::filesystem::remove_all(out + "/sdf", error);
}

ExitCode export_finished_pile(const FolderRequest& request, const ExportRequest& to) {
  const std::vector<std::string> formats = choose_formats(to.formats);
  const SavedRun saved = open_saved_run(request.folder);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  const PileState pile = load_pile_of(saved);
  const PileModel model = build_pile_model(assets, pile);
  const std::string out = to.out.empty() ? request.folder + "/export" : to.out;
  prepare(out, to.force);
  Progress progress(choose_progress_style(request.options.quiet));
  progress.start("export");
  std::size_t files = 0;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    progress.update(double(i) / double(formats.size()), formats[i]);
    files += export_pile(model, formats[i], out).size();
  }
  progress.finish(std::to_string(model.pieces.size()) + " pieces, " + std::to_string(files) +
                  " files and folders");
  std::printf("%s\n", out.c_str());
  return ExitCode::done;
}

Action declare(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<ExportRequest>();
  add_folder_options(line, *of);
  line.add("--format", request->formats, join_formats())
      .shows_default_text("all")
      .metavar("FORMAT")
      .separated_by(',');
  line.add("--out", request->out, "Output folder")
      .shows_default_text("FOLDER/export")
      .metavar("DIR");
  line.add_flag("--force", request->force, "Replace the files of an earlier export");
  return [of, request] { return export_finished_pile(*of, *request); };
}

}  // namespace

Command export_command() {
  return {"", "export", "The pile of a finished run as STL, PLY, OBJ, glTF or SDF", declare};
}

}  // namespace rubble
