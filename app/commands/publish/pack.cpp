// `rubble pack`: what a dataset needs to be handed on.
#include <memory>

#include "app/card/batch_card.h"
#include "app/card/dataset_card.h"
#include "app/card/slam_settings.h"
#include "app/card/viewer_settings.h"
#include "app/command_line/command.h"
#include "app/support/json_members.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

struct PackRequest {
  std::string folder;     // of a run or a batch
  bool card = false;      // --card
  bool settings = false;  // --settings
  bool force = false;     // --force
  CardText text;          // --title, --licence
  std::string splits;     // --splits; empty: those of SplitShares
};

using Files = std::map<std::string, std::string>;  // name in the folder -> text

// As the run's robots.json has them; empty without robots.
FirstLinks find_first_links(const std::string& folder, const Scenario& scenario) {
  FirstLinks links;
  if (scenario.robots.empty()) return links;
  const std::string path = folder + "/robots/robots.json";
  const nlohmann::ordered_json json = parse_json_text(read_whole_file(path), path);
  for (const JsonMembers& robot : JsonMembers(json, path).list("robots")) {
    const std::vector<JsonMembers> of = robot.list("links");
    if (!of.empty()) links[robot.text("name")] = of.front().text("name");
  }
  return links;
}

Files make_run_files(const PackRequest& request) {
  const FinishedRun saved = open_finished_run(request.folder);
  Files files;
  if (request.settings) {
    const Scenario scenario = stated_scenario(saved.manifest.provenance);
    for (const auto& settings : {make_slam_settings(scenario, find_first_links(saved.folder, scenario)), make_viewer_settings(scenario)})
      for (const auto& [name, text] : settings) files["settings/" + name] = text;
    if (!scenario.imus.empty() && files.count("settings/kalibr/imu.yaml") == 0)
      print_err("warning: no inertial unit rides with any camera, so the settings of SLAM programs describe none\n");
  }
  if (request.card) files["README.md"] = make_dataset_card(saved, request.text);
  files["SHA256SUMS"] = make_checksums(saved, files);
  return files;
}

// A split that was asked for and into which no seed falls.
void warn_of_empty(const Files& splits, const FinishedBatch& batch, const SplitShares& shares) {
  for (std::size_t i = 0; i < kSplits.size(); ++i)
    if (shares.as_list()[i] > 0 && splits.at(split_file(i)).empty())
      print_err("warning: %s is empty: none of the seeds %s falls there; run more seeds, or change --splits\n",
                split_file(i).c_str(), batch.seeds.c_str());
}

Files make_batch_files(const PackRequest& request) {
  if (request.settings)
    throw InputError({request.folder, 0, "--settings", "settings belong to one run, and this is a batch", "", "",
                      "give the folder of a run in it"});
  const FinishedBatch batch = open_finished_batch(request.folder);
  Files files;
  if (request.card) {
    files = make_splits(batch, request.text.shares);
    warn_of_empty(files, batch, request.text.shares);
    files["README.md"] = make_batch_card(batch, request.text);
  }
  files["SHA256SUMS"] = make_batch_checksums(batch, files);
  return files;
}

ExitCode pack(PackRequest request) {
  if (!request.splits.empty()) request.text.shares = parse_shares(request.splits);
  const Files files = is_batch_folder(request.folder) ? make_batch_files(request) : make_run_files(request);
  std::vector<std::string> names;
  for (const auto& item : files) names.push_back(item.first);
  refuse_to_replace(request.folder, names, request.force);
  for (const auto& [name, text] : files) {
    const std::string path = request.folder + "/" + name;
    if (const std::size_t slash = name.rfind('/'); slash != std::string::npos)
      make_folder_below(request.folder, name.substr(0, slash));
    write_text_file(path, text);
    print_out("%s\n", path.c_str());
  }
  return ExitCode::done;
}

Action declare_pack(CommandLine& line) {
  const auto request = std::make_shared<PackRequest>();
  line.add("folder", request->folder, "The output folder of a run or of a batch").required().metavar("DIR");
  const Option card =
      line.add_flag("--card", request->card,
                    "Write README.md, a card that describes the dataset and its reproduction");
  line.add_flag(
      "--settings", request->settings,
      "Write settings/ for ORB-SLAM3, OpenVINS, Kalibr, RTAB-Map, evo, RViz and Foxglove");
  line.add("--title", request->text.title, "Title of the card")
      .shows_default_text("the name of the script and the seed")
      .metavar("TEXT")
      .needs(card);
  line.add("--licence", request->text.licence, "Licence of the dataset, as in CC-BY-4.0")
      .metavar("NAME")
      .needs(card);
  line.add("--splits", request->splits, "Shares of training, validation and test seeds, in percent")
      .shows_default_text("80,10,10")
      .metavar("TRAIN,VAL,TEST")
      .needs(card);
  line.add_flag("--force", request->force, "Replace the files of an earlier call");
  return [request] { return pack(*request); };
}

}  // namespace

Command pack_command() {
  return {"", "pack", "Prepare a dataset for publication: checksums, card, settings", declare_pack};
}

}  // namespace rubble
