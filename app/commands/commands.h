// The subcommands of `rubble`. Each returns its exit code or throws InputError, RunError or
// Stopped.
#pragma once

#include <string>

#include "app/batch/batch.h"
#include "app/batch/suite.h"
#include "app/commands/verify.h"
#include "app/drive/drive_request.h"
#include "app/pipeline/run_request.h"
#include "kernel/base/error.h"

namespace rubble {

// The whole pipeline: script, settled pile, scene, frames, files, manifest.
ExitCode run_mission(const RunRequest& request);
// The pile only: pile.bin, pile.stl, manifest.json.
ExitCode settle_mission(const RunRequest& request);
// The mission's camera, light and files over the pile of the finished run in the folder `from`.
ExitCode render_saved_pile(const std::string& from, const RunRequest& request);
// Goes on with a run that was stopped or killed.
ExitCode resume_run(const FolderRequest& request);
// Runs again from the manifest alone and compares: `differs` when anything does. The result goes to
// standard output.
ExitCode verify_run(const VerifyRequest& request);
// What recordings or folders of runs hold, and which file is damaged at which byte: `differs` when
// one is.
ExitCode print_info_of(const std::vector<std::string>& paths);
// The voids of the pile of a finished run, as files beside it (docs/voids.md).
ExitCode map_voids(const FolderRequest& request, const VoidRequest& voids);
// A picture of the pile, cut open: cut faces marked, a person for scale.
ExitCode draw_cutaway(const FolderRequest& request, const CutawayRequest& cutaway);
// Errors of an estimated trajectory, on standard output.
ExitCode eval_trajectory(const TrajectoryRequest& request);
// COLMAP's models of datasets against the true cameras and surface, as a table.
ExitCode eval_sfm(const SfmRequest& request);
// A mesh or point cloud against the true surface.
ExitCode eval_surface(const SurfaceRequest& request);
// A map against the surface that its run saw, and against the voids (docs/map_score.md).
ExitCode eval_map(const MapRequest& request);
// The pile of the finished run as meshes and worlds for other programs.
ExitCode export_saved_pile(const FolderRequest& request, const ExportRequest& to);
// Resolves everything, runs nothing, prints the complete scenario as JSON on standard output.
ExitCode check_mission(const RunRequest& request);
// A table of what is sound and what is not in a pack; json: as JSON. bad_input when there are errors.
// pack: a folder with a pack.lua, or the name of a bundled one.
ExitCode check_assets_of(const std::string& pack, bool json);
// A picture of every asset with its name. out: path of a PNG or JPEG; empty: NAME.png. tile: width
// of each; unit: pixel
ExitCode show_assets(const std::string& pack, const std::string& out, int tile);
// Versions, EGL device and GL renderer in use, threads, on standard output.
ExitCode print_info(const InfoRequest& request);

}  // namespace rubble
