// The subcommands of `rubble`. Each returns its exit code or throws InputError or RunError.
#pragma once

#include "app/run_request.h"
#include "kernel/base/error.h"

namespace rubble {

// The whole pipeline: script, settled pile, scene, frames, files, manifest.
ExitCode run_mission(const RunRequest& request);
// The pile only: pile.bin, pile.stl, manifest.json.
ExitCode settle_mission(const RunRequest& request);
// Resolves everything, runs nothing, prints the complete scenario as JSON on standard output.
ExitCode check_mission(const RunRequest& request);
// Versions, EGL device and GL renderer in use, threads, on standard output.
ExitCode print_info();

}  // namespace rubble
