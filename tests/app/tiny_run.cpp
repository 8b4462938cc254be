#include "tests/app/tiny_run.h"

namespace rubble::testing {

using Json = nlohmann::ordered_json;

Json read_manifest(const std::string& folder) {
  return Json::parse(read_file(folder + "/manifest.json"));
}

Json reproducible(const std::string& folder) {
  Json manifest = read_manifest(folder);
  manifest.erase("not_reproducible");
  return manifest;
}

void run_tiny(const ScratchFolder& scratch, const std::string& name, const std::string& more) {
  write_file(scratch / "tiny.lua", kTinyMission);
  const Outcome run =
      run_rubble("run " + (scratch / "tiny.lua") + " --out " + (scratch / name) + " " + more);
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

void alter(const std::string& file, const std::string& from, const std::string& to) {
  std::string text = read_file(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " in " << file;
  write_file(file, text.replace(at, from.size(), to));
}

}  // namespace rubble::testing
