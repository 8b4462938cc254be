#include "app/mission/finished_run.h"

#include <filesystem>

#include "app/fines/pile_fines.h"
#include "app/provenance/run_folder.h"
#include "app/surroundings/pile_surroundings.h"
#include "io/base/atomic_file.h"
#include "io/state/pile_state_file.h"
#include "kernel/base/hash.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {

Manifest load_manifest(const std::string& path) {
  const std::string text = read_whole_file(path);
  Manifest manifest = manifest_from_json(text, path);
  std::vector<Diagnostic> altered;
  for (const std::string& sentence : find_altered_parts(text, path))
    altered.push_back({path, 0, "", sentence, "", "", ""});
  if (!altered.empty()) throw InputError(std::move(altered));
  return manifest;
}

FinishedRun open_finished_run(const std::string& folder) {
  allow_results(folder);
  const std::string path = folder + "/manifest.json";
  std::error_code failed;
  if (!std::filesystem::is_directory(folder, failed))
    throw InputError({folder, 0, "", "no such folder", "the output folder of a run", "", ""});
  if (!std::filesystem::exists(path, failed) && is_unfinished(folder))
    throw InputError({folder, 0, "", "the run in it is not finished", "", "",
                      "`rubble resume " + folder + "` continues it"});
  return {folder, load_manifest(path)};
}

AssetLibrary load_assets_of(const FinishedRun& saved, const std::vector<std::string>& folders) {
  std::vector<std::string> all = folders;
  all.insert(all.end(), saved.manifest.pack_folders.begin(), saved.manifest.pack_folders.end());
  return load_assets(saved.manifest.provenance, all);
}

PileState load_pile_of(const FinishedRun& saved) {
  const std::string path = saved.folder + "/pile.bin";
  PileState pile = load_pile_state(path);
  const std::string found = hex64(pile.state_hash());
  const std::string stated = saved.manifest.pile.state_hash;
  if (found != stated)
    throw InputError({path, 0, "", "is not the pile of the manifest beside it",
                      "the state hash " + stated, found, ""});
  load_fines_of(stated_scenario(saved.manifest.provenance).fines, saved.folder, pile);
  return pile;
}

PileState load_pile_of(const FinishedRun& saved, const AssetLibrary& assets) {
  PileState pile = load_pile_of(saved);
  lay_surroundings(stated_scenario(saved.manifest.provenance), assets, pile);
  return pile;
}

}  // namespace rubble
