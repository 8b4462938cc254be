// `rubble verify`: whether a dataset can be had again. Everything is run anew from its manifest
// alone, and compared.
#include <memory>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/run.h"
#include "app/provenance/compare.h"
#include "app/provenance/differing_pixel.h"
#include "app/provenance/manifest.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/playback/recording_check.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// missing: what lies there is as it should be, but not all of it does.
enum class Verdict { equal, differs, missing, skipped };

// What became of one part of a dataset: "manifest", "recorded files", "scenario", "assets", "pile",
// "frames", "metrics", "files".
struct Finding {
  std::string part;
  Verdict verdict = Verdict::equal;
  std::string detail;  // where it differs first, or what was compared
};

struct Verification {
  std::vector<Finding> findings;   // in the order of the run
  std::vector<std::string> notes;  // what is another here: versions, graphics driver
};

struct VerifyRequest {
  FolderRequest of;
  std::string work;        // --work: where the run is made anew; empty: a temporary folder
  std::string keep;        // --keep: a new folder for it, that stays
  bool pile_only = false;  // --pile-only: no frames
  bool json = false;       // --json
};

// Where the run is made anew; goes with all that is in it.
class WorkFolder {
 public:
  explicit WorkFolder(const std::string& asked) {
    if (!asked.empty()) make_output_folder(asked);
    path_ = make_private_folder(asked.empty() ? fs::temp_directory_path().string() : asked, "rubble-verify");
  }
  ~WorkFolder() { remove_output_folder(path_); }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

class Verifier {
 public:
  explicit Verifier(const VerifyRequest& request) : request_(request) {
    allow_results(request.of.folder);
    const std::string path = request.of.folder + "/manifest.json";
    if (!fs::exists(path) && is_unfinished(request.of.folder))
      throw InputError({request.of.folder, 0, "", "the run in it is not finished", "", "",
                        "`rubble resume " + request.of.folder + "` continues it"});
    if (!fs::is_directory(request.of.folder))
      throw InputError({request.of.folder, 0, "", "no such folder", "the output folder of a run", "", ""});
    text_ = read_whole_file(path);
    was_ = manifest_from_json(text_, path);
  }

  Verification run() {
    check_manifest();
    check_recorded_files();
    for (const std::string& line : describe_differences(was_.program, build_info()))
      result_.notes.push_back(line);
    check_scenario();
    run_anew();
    return std::move(result_);
  }

 private:
  void add(const char* part, bool equal, std::string detail) {
    result_.findings.push_back(
        {part, equal ? Verdict::equal : Verdict::differs, std::move(detail)});
  }
  void skip(const char* part, const char* why) {
    result_.findings.push_back({part, Verdict::skipped, why});
  }
  std::string recorded(const std::string& name) const { return request_.of.folder + "/" + name; }

  void check_manifest() {
    const auto altered = find_altered_parts(text_, request_.of.folder + "/manifest.json");
    std::string all;
    for (const std::string& sentence : altered) all += (all.empty() ? "" : "; ") + sentence;
    add("manifest", altered.empty(), altered.empty() ? "every seal holds" : all);
  }

  // The files beside the manifest, as they lie there.
  void check_recorded_files() {
    std::string wrong;
    std::size_t missing = 0;
    for (const auto& [name, hash] : was_.outputs) {
      const bool there = fs::is_regular_file(recorded(name));
      if (there && sha256_of_file(recorded(name)) == hash) continue;
      if (!there) ++missing;
      wrong += (wrong.empty() ? "" : "; ") + name + (there ? " was altered" : " is missing");
      if (!there) continue;
      altered_.insert(name);
      if (const auto fault = find_fault(recorded(name)))
        wrong += " (at byte " + std::to_string(fault->byte) + ": " + fault->what + ")";
    }
    add("recorded files", wrong.empty(),
        wrong.empty() ? std::to_string(was_.outputs.size()) + " as the manifest says" : wrong);
    if (missing > 0 && altered_.empty()) result_.findings.back().verdict = Verdict::missing;
    if (missing > 0 && missing == was_.outputs.size())
      result_.findings.back().detail = "all " + std::to_string(missing) + " are missing";
  }

  void check_scenario() {
    try {
      const Json is = Json::parse(scenario_to_json(load_mission(was_.provenance).scenario));
      const std::string apart = describe_difference(Json::parse(was_.provenance.scenario), is);
      add("scenario", apart.empty(),
          apart.empty() ? "follows from the script" : "what the script gives now: " + apart);
    } catch (const InputError& error) {
      add("scenario", false, std::string("the script is not understood: ") + error.what());
    }
  }

  void run_anew() {
    std::vector<std::string> folders = request_.of.asset_packs;
    folders.insert(folders.end(), was_.pack_folders.begin(), was_.pack_folders.end());
    RunContext context(request_.of.options);
    const ResolvedMission mission = resolve_mission(was_.provenance, folders, context);
    add("assets", true, std::to_string(mission.assets.types.size()) + " found by content");
    std::optional<WorkFolder> work;
    if (request_.keep.empty()) work.emplace(request_.work);
    RunFolder folder = RunFolder::create(work ? work->path() + "/run" : request_.keep, false);
    folder.begin(describe_unfinished(mission));
    stop_on_signals();
    const bool has_frames = was_.provenance.kind != RunKind::settle;
    bool same_pile = false;
    const StageResults made =
        run_stages(mission, folder, context, has_frames && !request_.pile_only,
                   [&](const SettledPile& pile) { return same_pile = check_pile(pile.state); });
    if (!same_pile) return skip("frames", "the pile is another already");
    if (has_frames && request_.pile_only) skip("frames", "--pile-only");
    if (has_frames && !request_.pile_only) check_frames(made.frames, folder);
    if (!request_.pile_only) check_metrics(made.metrics);
    check_files(folder, folder.hash_files(context.threads()));
    if (work) return;
    write_manifest(mission, made.pile, made.metrics, made.frames, folder, context);
    folder.finish();
    result_.notes.push_back("what was made anew is kept in " + request_.keep);
  }

  bool check_pile(const PileState& found) {
    const std::string is = hex64(found.state_hash()), &was = was_.pile.state_hash;
    if (is == was) {
      add("pile", true, "state hash " + is);
      return true;
    }
    std::string detail = "state hash " + is + " instead of " + was;
    try {
      const PileState pile = load_pile_state(recorded("pile.bin"));
      const std::string apart = describe_difference(pile, found);
      detail += apart.empty() ? "; yet pile.bin is equal: the manifest was altered" : "; " + apart;
    } catch (const InputError&) {  // the recorded files were looked at before
    }
    add("pile", false, detail);
    return false;
  }

  void check_frames(const RecordedFrames& frames, const RunFolder& folder) {
    const FrameDifference apart = find_difference(was_.frames, frames.hashes.compact());
    add("frames", apart.why.empty(),
        apart.why.empty() ? std::to_string(was_.frames.frames.size()) + " frames"
                          : apart.why + describe_pixel(apart, was_.frames, request_.of.folder, folder.path(), altered_));
    for (const auto& [name, value] : frames.environment) {
      const auto before = was_.environment.find(name);
      if (name != "threads" && before != was_.environment.end() && before->second != value)
        result_.notes.push_back(name + " " + value + " instead of " + before->second);
    }
  }

  void check_metrics(const Metrics& found) {
    const std::string apart = describe_difference(Json(was_.metrics), Json(found));
    add("metrics", apart.empty(), apart.empty() ? std::to_string(found.size()) : apart);
  }

  void check_files(const RunFolder& folder, const std::map<std::string, std::string>& hashes) {
    std::string wrong;
    for (const auto& [name, hash] : was_.outputs) {
      const auto is = hashes.find(name);
      if (is == hashes.end()) {
        if (!request_.pile_only) wrong += name + " is not made any more; ";
      } else if (is->second != hash) {
        wrong += name + ": " + compare_file(name, folder) + "; ";
      }
    }
    for (const auto& item : hashes)
      if (!was_.outputs.count(item.first)) wrong += item.first + " is new; ";
    if (!wrong.empty()) wrong.resize(wrong.size() - 2);
    add("files", wrong.empty(), wrong.empty() ? "made anew, the same bytes" : wrong);
    for (const std::string& name : altered_)
      if (hashes.count(name))
        result_.findings.back().detail +=
            "; in the recorded " + name + ", " +
            describe_difference_of_files(folder.file(name), recorded(name));
  }

  std::string compare_file(const std::string& name, const RunFolder& folder) const {
    if (!fs::is_regular_file(recorded(name))) return "another hash; the recorded file is missing";
    const std::string apart = describe_difference_of_files(recorded(name), folder.file(name));
    return apart.empty() ? "the recorded file is the same: the manifest was altered" : apart;
  }

  const VerifyRequest& request_;
  std::string text_;
  Manifest was_;
  std::set<std::string> altered_;  // recorded files that are not as the manifest says
  Verification result_;
};

constexpr const char* kVerdictNames[] = {"equal", "differs", "missing", "skipped"};

bool has(const Verification& verification, Verdict verdict) {
  for (const Finding& finding : verification.findings)
    if (finding.verdict == verdict) return true;
  return false;
}

// Nothing differs, and nothing is missing.
bool is_equal(const Verification& verification) {
  return !has(verification, Verdict::differs) && !has(verification, Verdict::missing);
}

std::string conclude(const Verification& verification) {
  if (has(verification, Verdict::differs)) return "not the same";
  if (!has(verification, Verdict::missing)) return "the same";
  return "files are missing; `rubble remake` makes them again, the same";
}

// Throws InputError for a folder without a manifest, or with one that cannot be read, and for packs
// that are nowhere to be found.
Verification verify(const VerifyRequest& request) {
  try {
    return Verifier(request).run();
  } catch (const Stopped&) {
    throw Stopped("stopped by a signal; nothing was compared to the end");
  }
}

// For a person, and for a program.
std::string to_text(const Verification& verification) {
  std::string text;
  for (const Finding& finding : verification.findings) {
    std::string row = finding.part;
    row.resize(16, ' ');
    row += kVerdictNames[int(finding.verdict)];
    row.resize(25, ' ');
    text += row + finding.detail + "\n";
  }
  for (const std::string& note : verification.notes) text += "here is         " + note + "\n";
  return text + conclude(verification) + "\n";
}

std::string to_json(const Verification& verification) {
  Json json;
  json["equal"] = is_equal(verification);
  json["missing"] = has(verification, Verdict::missing);
  json["findings"] = Json::array();
  for (const Finding& finding : verification.findings)
    json["findings"].push_back({{"part", finding.part},
                                {"verdict", kVerdictNames[int(finding.verdict)]},
                                {"detail", finding.detail}});
  json["notes"] = verification.notes;
  return json.dump(2) + "\n";
}

ExitCode verify_run(const VerifyRequest& request) {
  const Verification verification = verify(request);
  print_result(request.json ? to_json(verification) : to_text(verification), request.json);
  return is_equal(verification) ? ExitCode::done : ExitCode::differs;
}

Action declare_verify(CommandLine& line) {
  const auto request = std::make_shared<VerifyRequest>();
  add_folder_options(line, request->of);
  add_run_options(line, request->of.options);
  const Option work =
      line.add("--work", request->work, "Folder for the new run").shows_default_text("$TMPDIR").metavar("DIR");
  const Option keep =
      line.add("--keep", request->keep, "Keep the new run, in this new folder").metavar("DIR").excludes(work);
  line.add_flag("--pile-only", request->pile_only, "Settle again; render nothing").excludes(keep).excludes(work);
  line.add_flag("--json", request->json, "Print the result as JSON");
  return [request] { return verify_run(*request); };
}

}  // namespace

Command verify_command() {
  return {"", "verify", "Repeat a run from its manifest and compare every hash", declare_verify};
}

}  // namespace rubble
