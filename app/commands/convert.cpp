// `rubble convert`: a recorded dataset in further formats, written by the recorders of `rubble run`.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/control/robot_control.h"
#include "app/formats/recording_formats.h"
#include "app/mission/finished_run.h"
#include "app/mission/resolved_mission.h"
#include "app/pipeline/recorders.h"
#include "app/provenance/earlier_files.h"
#include "app/robots/robot_log.h"
#include "app/support/print.h"
#include "app/support/run_request.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/base/remove_files.h"
#include "io/playback/dataset_player.h"
#include "io/recording/recording_queue.h"

namespace rubble {
namespace {

// Into which formats a dataset goes, and where to.
struct ConvertRequest {
  std::vector<std::string> formats;  // --to, of recording_formats()
  std::string out;                   // --out; empty: `convert` in the folder of the run
  bool force = false;                // --force
};

// The scenario of the dataset, with these outputs. Throws InputError where a mission with them would be refused.
Scenario scenario_for(const FinishedRun& saved, const std::vector<std::string>& names) {
  Scenario scenario = stated_scenario(saved.manifest.provenance);
  for (const RecordingFormat& format : recording_formats()) scenario.outputs.*format.wanted = false;
  for (const std::string& name : names) scenario.outputs.*find_recording_format(name).wanted = true;
  scenario.validate();
  return scenario;
}

// What is to be read back for all formats together.
PlayedSamples samples_for(const std::vector<std::string>& names, const Scenario& scenario, const FinishedRun& saved) {
  PlayedSamples wanted;
  for (const std::string& name : names) {
    const HeldSamples& holds = find_recording_format(name).holds;
    wanted.imus = wanted.imus || holds.imus;
    wanted.biases = wanted.biases || holds.biases;
    wanted.scans = wanted.scans || holds.scans;
    wanted.readings = wanted.readings || holds.readings;
    if (holds.robots && !scenario.robots.empty())
      throw InputError({saved.folder, 0, "--to " + name, "readings of robots cannot be read back from recordings",
                        "a format without robots", name, "`rubble remake` with outputs." + name + " = true makes it"});
  }
  return wanted;
}

Recording recording_of(const Scenario& scenario, const FinishedRun& saved, const AssetLibrary& assets, const PileState& pile,
                       RunContext& context) {
  if (scenario.robots.empty()) return describe_recording(scenario, assets, pile);
  const std::vector<MissionRobot> robots = make_robots({saved.manifest.provenance, scenario, assets}, context);
  const std::vector<RobotRecord> records = describe_robots(scenario, robots);
  Recording recording = describe_recording(scenario, assets, pile, records);
  const Ride& ride = scenario.trajectory.ride;
  const std::vector<std::string> names = robot_names(scenario.robots);
  const auto carrier = std::size_t(std::find(names.begin(), names.end(), ride.robot) - names.begin());
  if (carrier < names.size())
    recording.mount = {ride.link.empty() ? records[carrier].frame_of(0) : records[carrier].frame_named(ride.link), ride.link_from_rig()};
  return recording;
}

// Frames of each camera, by the hashes of the manifest.
std::vector<int> count_recorded(const FinishedRun& saved, const Recording& recording, const Scenario& scenario) {
  const FrameHashes& hashes = saved.manifest.frames;
  std::vector<int> frames;
  for (const CameraRecord& camera : recording.cameras) {
    const std::string channel = !scenario.names_cameras() ? "rgb" : camera.name + "/rgb";
    const auto column = std::find(hashes.channels.begin(), hashes.channels.end(), channel) - hashes.channels.begin();
    frames.push_back(int(std::count_if(hashes.frames.begin(), hashes.frames.end(), [&](const auto& row) {
      return std::size_t(column) < row.size() && row[std::size_t(column)] != 0;
    })));
  }
  return frames;
}

void check_count(const FinishedRun& saved, int expected, int found) {
  if (found == expected) return;
  throw InputError({saved.folder, 0, "", "the recording is not whole", std::to_string(expected) + " frames, as the manifest states",
                    std::to_string(found), "`rubble info " + saved.folder + "` finds damaged files"});
}

// Files that conversions into this folder left, a name in a line.
constexpr const char* kConverted = "converted.txt";

bool belongs_to(std::string_view file, const RecordingFormat& format) {
  if (file.rfind(kCamerasFolder + std::string("/"), 0) == 0) {
    const std::size_t slash = file.find('/', std::string_view(kCamerasFolder).size() + 1);
    file = slash == std::string_view::npos ? std::string_view() : file.substr(slash + 1);
  }
  return file == format.leaves || (!format.beside.empty() && file == format.beside) || file.rfind(format.leaves + "/", 0) == 0;
}

bool belongs_to_any(const std::string& file, const std::vector<std::string>& formats) {
  return std::any_of(formats.begin(), formats.end(),
                     [&](const std::string& name) { return belongs_to(file, find_recording_format(name)); });
}

std::vector<std::string> list_converted(const std::string& out) {
  std::vector<std::string> files;
  std::error_code failed;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(out + "/" + kConverted, failed))) return files;
  std::istringstream lines(read_whole_file(out + "/" + kConverted));
  for (std::string line; std::getline(lines, line);) files.push_back(line);
  return files;
}

// Everything below the folder that has a name of these formats.
std::vector<std::string> list_named(const std::string& out, const std::vector<std::string>& formats) {
  std::vector<std::string> files;
  std::vector<std::string> folders{kCamerasFolder};
  std::error_code failed;
  for (const std::string& name : formats) {
    const RecordingFormat& format = find_recording_format(name);
    if (format.is_folder)
      folders.push_back(format.leaves);
    else if (std::filesystem::exists(out + "/" + format.leaves, failed))
      files.push_back(format.leaves);
    if (!format.beside.empty() && std::filesystem::exists(out + "/" + format.beside, failed)) files.push_back(format.beside);
  }
  for (const std::string& folder : folders)
    for (std::string& file : list_plain_files(out, folder))
      if (belongs_to_any(file, formats)) files.push_back(std::move(file));
  return files;
}

// What an earlier conversion to these formats left is ours to replace; a file of somebody else among it is an error.
void prepare_conversion(const std::string& out, const std::vector<std::string>& formats, bool force) {
  std::vector<std::string> files;
  for (const std::string& name : formats) {
    const RecordingFormat& format = find_recording_format(name);
    if (!format.is_folder) files.push_back(format.leaves);
    if (!format.beside.empty()) files.push_back(format.beside);
  }
  if (force)
    for (const std::string& file : list_converted(out))
      if (belongs_to_any(file, formats)) files.push_back(file);
  for (const std::string& file : force ? list_named(out, formats) : std::vector<std::string>())
    if (std::find(files.begin(), files.end(), file) == files.end())
      throw InputError({out + "/" + file, 0, "", "is where the conversion writes, and no conversion left it", "", "",
                        "move it elsewhere, or choose another folder by --out"});
  prepare_output_folder(out, force, files);
  remove_empty_parents(out, files);
}

void note_converted(const std::string& out, const std::vector<std::string>& formats) {
  std::vector<std::string> files = list_named(out, formats);
  std::error_code failed;
  for (const std::string& file : list_converted(out))
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(out + "/" + file, failed))) files.push_back(file);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::string text;
  for (const std::string& file : files) text += file + "\n";
  write_text_file(out + "/" + kConverted, text);
}

ExitCode convert(const FolderRequest& request, const ConvertRequest& to) {
  stop_on_signals();
  const FinishedRun saved = open_finished_run(request.folder);
  const Scenario scenario = scenario_for(saved, to.formats);
  RunContext context(request.options);
  const AssetLibrary assets = load_assets_of(saved, request.asset_packs);
  const PileState pile = load_pile_of(saved, assets);
  const Recording recording = recording_of(scenario, saved, assets, pile, context);
  std::vector<Intrinsics> intrinsics;
  for (const MountedCamera& camera : scenario.cameras) intrinsics.push_back(camera.camera.intrinsics());
  DatasetPlayer player({saved.folder, recording, intrinsics}, samples_for(to.formats, scenario, saved));
  const std::string out = output_folder_of(to.out, request.folder, "convert");
  refuse_run_folder(out, request.folder, "convert");
  prepare_conversion(out, to.formats, to.force);
  const std::vector<int> frames = count_recorded(saved, recording, scenario);
  const std::string title = recording_title(saved.manifest.provenance.script.path, scenario.seed, pile);
  RecorderSet set = make_recorders({scenario, recording, frames, title}, out);
  RecordingQueue queue(std::move(set.recorders));
  context.progress.start("convert");
  int expected = 0, found = 0;
  for (const int count : frames) expected += count;
  player.play([&](Sample sample) {
    if (std::holds_alternative<Frame>(sample)) {
      ++found;
      context.progress.update(double(found) / std::max(expected, 1), "frame " + std::to_string(found) + " of " + std::to_string(expected));
    }
    throw_if_stopped("");
    queue.push(std::move(sample));
  });
  check_count(saved, expected, found);
  queue.finish();
  note_converted(out, to.formats);
  context.progress.finish(std::to_string(found) + " frames");
  for (const std::string& note : player.notes()) print_err("%s\n", note.c_str());
  for (const std::string& name : set.names) print_out("%s/%s\n", out.c_str(), name.c_str());
  return ExitCode::done;
}

Action declare_convert(CommandLine& line) {
  const auto of = std::make_shared<FolderRequest>();
  const auto request = std::make_shared<ConvertRequest>();
  std::string names;
  for (const RecordingFormat& format : recording_formats()) names += (names.empty() ? "" : ", ") + format.name;
  add_folder_options(line, *of);
  add_quiet_option(line, of->options.quiet);
  line.add("--to", request->formats, names).required().metavar("FORMAT").separated_by(',');
  line.add("--out", request->out, "Output folder").shows_default_text("FOLDER/convert").metavar("DIR");
  line.add_flag("--force", request->force, "Replace the files of an earlier conversion");
  return [of, request] { return convert(*of, *request); };
}

}  // namespace

Command convert_command() {
  return {"", "convert", "Convert a recorded dataset to further formats", declare_convert};
}

}  // namespace rubble
