// `rubble view`: a web page that shows a dataset in three dimensions.
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/mission/finished_run.h"
#include "app/provenance/earlier_files.h"
#include "app/support/print.h"
#include "app/view/dataset_page.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

struct ViewRequest {
  std::string folder;                    // of the run
  std::string out;                       // --out; empty: FOLDER/view.html
  std::vector<std::string> asset_packs;  // --assets: where packs may be now
  ViewOptions options;
};

ExitCode write_page(const ViewRequest& request) {
  if (three_code().empty())
    throw RunError(
        "this program was built without three.js: install libjs-three and build it again");
  const std::string path = request.out.empty() ? request.folder + "/view.html" : request.out;
  refuse_recorded_file(path, "--out");
  const FinishedRun saved = open_finished_run(request.folder);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  write_text_file(path, make_dataset_page(saved, assets, request.options));
  if (const int others = count_voids_of_other_piles(saved); others > 0)
    print_err("warning: %d surfaces in %s/voids are of another pile, or do not say of which: left out; `rubble voids %s "
              "--force` maps the voids anew\n", others, saved.folder.c_str(), saved.folder.c_str());
  print_out("%s\n", path.c_str());
  return ExitCode::done;
}

Action declare_view(CommandLine& line) {
  const auto request = std::make_shared<ViewRequest>();
  line.add("folder", request->folder, "The output folder of a run").required().metavar("DIR");
  line.add("--out", request->out, "Output page")
      .shows_default_text("FOLDER/view.html")
      .metavar("FILE");
  line.add("--frames", request->options.frames,
           "Largest number of pictures, evenly spaced along the path")
      .shows_default()
      .between(0, 10000);
  line.add("--width", request->options.width, "Width of a picture, in pixels")
      .shows_default()
      .between(32, 4000);
  line.add("--triangles", request->options.triangles,
           "Approximate largest number of triangles of all pieces")
      .shows_default()
      .between(1000, 100'000'000);
  add_packs_option(line, request->asset_packs,
                   "Folder of an asset pack of the run, if it was moved");
  return [request] { return write_page(*request); };
}

}  // namespace

Command view_command() {
  return {"", "view", "Write a web page that shows a dataset in 3-D: pile, voids, path",
          declare_view};
}

}  // namespace rubble
