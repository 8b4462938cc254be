// `rubble remake`: a dataset from its manifest alone.
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/mission/finished_run.h"
#include "app/pipeline/run.h"
#include "app/provenance/compare.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {
namespace {

struct RemakeRequest {
  std::string manifest;                  // the file, or the folder that it is in
  std::string out;                       // --out
  bool force = false;                    // --force
  std::vector<std::string> asset_packs;  // --assets: where packs may be now
  RunOptions options;
};

// What is not as the manifest says, a sentence each.
std::vector<std::string> compare(const Manifest& was, const Manifest& is) {
  std::vector<std::string> apart;
  if (was.pile.state_hash != is.pile.state_hash)
    apart.push_back("the pile: state hash " + is.pile.state_hash + " instead of " +
                    was.pile.state_hash);
  const FrameDifference frames = find_difference(was.frames, is.frames);
  if (!frames.why.empty()) apart.push_back("the frames: " + frames.why);
  for (const auto& [name, hash] : was.outputs) {
    const auto found = is.outputs.find(name);
    if (found == is.outputs.end())
      apart.push_back(name + " is not made any more");
    else if (found->second != hash)
      apart.push_back(name + ": SHA-256 " + found->second + " instead of " + hash);
  }
  for (const auto& item : is.outputs)
    if (!was.outputs.count(item.first)) apart.push_back(item.first + " is new");
  return apart;
}

ExitCode report(const Manifest& was, const Manifest& is) {
  const std::vector<std::string> apart = compare(was, is);
  for (const std::string& sentence : apart) print_out("differs: %s\n", sentence.c_str());
  if (apart.empty()) {
    print_out("the same: state hash %s, %zu frames, %zu files\n", is.pile.state_hash.c_str(),
              is.frames.frames.size(), is.outputs.size());
    return ExitCode::done;
  }
  for (const std::string& line : describe_differences(was.program, is.program))
    print_out("here is %s\n", line.c_str());
  for (const auto& [name, value] : is.environment) {
    const auto before = was.environment.find(name);
    if (name != "threads" && before != was.environment.end() && before->second != value)
      print_out("here is %s %s instead of %s\n", name.c_str(), value.c_str(),
                before->second.c_str());
  }
  print_out("not the same\n");
  return ExitCode::differs;
}

ExitCode remake(const RemakeRequest& request) {
  namespace fs = std::filesystem;
  stop_on_signals();
  std::error_code failed;
  const bool is_folder = fs::is_directory(request.manifest, failed);
  if (is_folder) allow_results(request.manifest);
  const std::string path = request.manifest + (is_folder ? "/manifest.json" : "");
  const Manifest was = load_manifest(path);
  if (fs::equivalent(fs::absolute(path).parent_path(), request.out, failed))
    throw InputError({path, 0, "--out", "would replace the dataset that the manifest is of", "", "",
                      "choose another folder; `rubble verify` compares in place"});
  std::vector<std::string> folders = request.asset_packs;
  folders.insert(folders.end(), was.pack_folders.begin(), was.pack_folders.end());
  RunContext context(request.options);
  const ResolvedMission mission = resolve_mission(was.provenance, folders, context);
  RunFolder folder = RunFolder::create(request.out, request.force);
  const ExitCode code = complete(mission, folder, context);
  const ExitCode same = report(was, load_manifest(folder.file("manifest.json")));
  return same == ExitCode::done ? code : same;
}

Action declare_remake(CommandLine& line) {
  const auto request = std::make_shared<RemakeRequest>();
  line.add("manifest", request->manifest, "manifest.json of a run, or its folder").required().metavar("PATH");
  line.add("--out", request->out, "Output folder").required().metavar("DIR");
  line.add_flag("--force", request->force, "Replace the files of an earlier run");
  add_packs_option(line, request->asset_packs,
                   "Folder of an asset pack of the run, if it was moved");
  add_run_options(line, request->options);
  add_checkpoint_option(line, request->options);
  return [request] { return remake(*request); };
}

}  // namespace

Command remake_command() {
  return {"", "remake", "Make a dataset again, from its manifest alone", declare_remake};
}

}  // namespace rubble
