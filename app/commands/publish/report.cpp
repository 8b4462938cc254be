// `rubble report`: a web page about a batch.
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/provenance/earlier_files.h"
#include "app/report/batch_report.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"

namespace rubble {
namespace {

struct ReportRequest {
  std::string folder;  // of the batch
  std::string out;     // --out; empty: FOLDER/report.html
  ReportOptions options;
};

ExitCode write_report(const ReportRequest& request) {
  namespace fs = std::filesystem;
  const std::string path = request.out.empty() ? request.folder + "/report.html" : request.out;
  refuse_recorded_file(path, "--out");
  for (const char* name : {"batch.json", "index.csv"}) {
    std::error_code failed;
    if (fs::equivalent(path, fs::path(request.folder) / name, failed))
      throw InputError({path, 0, "--out", "would replace a file of the batch", "another name", "", ""});
  }
  ReportOptions options = request.options;
  const std::string way = fs::proximate(request.folder, fs::absolute(path).parent_path()).string();
  options.way = way == "." ? "" : way + "/";
  write_text_file(path, make_batch_report(request.folder, options));
  print_out("%s\n", path.c_str());
  return ExitCode::done;
}

Action declare_report(CommandLine& line) {
  const auto request = std::make_shared<ReportRequest>();
  line.add("folder", request->folder, "The output folder of a batch").required().metavar("DIR");
  line.add("--out", request->out, "Output page")
      .shows_default_text("FOLDER/report.html")
      .metavar("FILE");
  line.add("--pictures", request->options.pictures, "Largest number of runs with pictures")
      .shows_default()
      .between(0, 100000);
  line.add("--width", request->options.width, "Width of a picture, in pixels")
      .shows_default()
      .between(32, 2000);
  return [request] { return write_report(*request); };
}

}  // namespace

Command report_command() {
  return {"", "report", "Write a web page about a batch: table, plots, pictures", declare_report};
}

}  // namespace rubble
