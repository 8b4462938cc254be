// `rubble export`: the pile of a finished run in other programs' formats.
#include <algorithm>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/control/robot_control.h"
#include "app/mission/finished_run.h"
#include "app/provenance/earlier_files.h"
#include "app/simulators/build_sim_scene.h"
#include "app/support/print.h"
#include "app/support/progress.h"
#include "io/base/atomic_file.h"
#include "io/base/remove_files.h"
#include "io/scenes/pile_export.h"

namespace rubble {
namespace {

// Into which formats a pile goes, and where to.
struct ExportRequest {
  std::vector<std::string> formats;  // --format, of mesh_formats(); empty: all
  std::string out;                   // --out; empty: `export` in the folder of the run
  std::string dynamic = "none";      // --dynamic: the pieces that may move, parse_dynamic()
  bool force = false;                // --force
};

// Every format asked for, once, or all of them. Throws InputError for an unknown one.
std::vector<MeshFormat> choose_formats(const std::vector<std::string>& asked) {
  if (asked.empty()) return mesh_formats();
  std::vector<MeshFormat> chosen;
  for (const std::string& name : asked) {
    const MeshFormat& format = find_mesh_format(name);
    const auto is_it = [&](const MeshFormat& other) { return other.name == name; };
    if (std::none_of(chosen.begin(), chosen.end(), is_it)) chosen.push_back(format);
  }
  return chosen;
}

// What an earlier export left is ours to replace; a file of somebody else in a folder of ours stays, and is an error.
void prepare(const std::string& out, bool force) {
  std::vector<std::string> files;
  for (const MeshFormat& format : mesh_formats())
    for (const std::string& name : format.leaves) {
      if (!format.is_folder) files.push_back(name);
      if (!format.is_folder || !force) continue;
      for (const std::string& file : list_plain_files(out, name))
        if (is_scene_file(file.substr(name.size() + 1))) files.push_back(file);
    }
  prepare_output_folder(out, force, files);
  remove_empty_parents(out, files);
}

// Of meshes no more than the pile is needed, also where the robots' files are gone.
BuiltScene build_model(const FolderRequest& request, const FinishedRun& saved, const std::vector<std::string>& formats,
                       const DynamicChoice& dynamic, ResolvedMission& mission, PileState& pile) {
  BuiltScene built;
  RunContext context(request.options);
  if (!needs_scene(formats)) {
    mission.assets = load_assets_of(saved, request.asset_packs);
    pile = load_pile_of(saved, mission.assets);
    built.model = build_mesh_model(mission.assets, pile, formats, context.threads());
    return built;
  }
  std::vector<std::string> folders = request.asset_packs;
  folders.insert(folders.end(), saved.manifest.pack_folders.begin(), saved.manifest.pack_folders.end());
  mission = resolve_mission(saved.manifest.provenance, folders, context);
  pile = load_pile_of(saved, mission.assets);
  const std::vector<MissionRobot> robots = with_lines_of_script(mission, [&] { return make_robots(mission, context); });
  built = build_sim_scene(mission, pile, robots, dynamic, context.threads());
  print_warnings(context.warnings);
  return built;
}

ExitCode export_finished_pile(const FolderRequest& request, const ExportRequest& to) {
  const std::vector<MeshFormat> formats = choose_formats(to.formats);
  const DynamicChoice dynamic = parse_dynamic(to.dynamic, "--dynamic");
  std::vector<std::string> names;
  for (const MeshFormat& format : formats) names.push_back(format.name);
  if (dynamic.kind != DynamicChoice::Kind::none && !needs_scene(names))
    throw InputError({"", 0, "--dynamic", "has no effect: meshes have no pieces that move", "a --format of sdf, mjcf, usd or urdf",
                      names.front(), ""});
  const FinishedRun saved = open_finished_run(request.folder);
  ResolvedMission mission;
  PileState pile;
  const BuiltScene built = build_model(request, saved, names, dynamic, mission, pile);
  const std::string out = output_folder_of(to.out, request.folder, "export");
  refuse_run_folder(out, request.folder, "export");
  prepare(out, to.force);
  Progress progress(choose_progress_style(request.options.quiet));
  progress.start("export");
  std::size_t files = 0;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    progress.update(double(i) / double(formats.size()), formats[i].name);
    files += export_pile(built.model, formats[i].name, out).size();
  }
  progress.finish(std::to_string(built.model.pile.pieces.size()) + " pieces, " + std::to_string(files) +
                  " files and folders");
  for (const std::string& note : list_notes(built, names)) print_err("note: %s\n", note.c_str());
  print_out("%s\n", out.c_str());
  return ExitCode::done;
}

Action declare_export(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<ExportRequest>();
  add_folder_options(line, *of);
  add_quiet_option(line, of->options.quiet);
  line.add("--format", request->formats, join_mesh_formats(" or "))
      .shows_default_text("all")
      .metavar("FORMAT")
      .separated_by(',');
  line.add("--out", request->out, "Output folder")
      .shows_default_text("FOLDER/export")
      .metavar("DIR");
  line.add("--dynamic", request->dynamic,
           "Pieces that may move in sdf, mjcf, usd and urdf: all, none, near=X,Y,R (an upright cylinder) or near=X,Y,Z,R "
           "(a sphere); metres. All others are fixed")
      .metavar("CHOICE");
  line.add_flag("--force", request->force, "Replace the files of an earlier export");
  return [of, request] { return export_finished_pile(*of, *request); };
}

}  // namespace

Command export_command() {
  return {"", "export", "Export the pile of a finished run as meshes, or as a scene for MuJoCo, Gazebo, Drake, USD or Bullet",
          declare_export};
}

}  // namespace rubble
