#include "kernel/base/system/file_sandbox.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <mutex>

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct Sandbox {
  fs::path folder;  // empty: there is no sandbox
  std::vector<fs::path> own, results;  // read
  std::vector<fs::path> outputs;       // written; empty: anything
  fs::path cache;                      // both; empty: none
};

// Readers take no lock: a child process is forked while other threads may hold one.
std::atomic<const Sandbox*>& current() {
  static std::atomic<const Sandbox*> sandbox{nullptr};
  return sandbox;
}

const Sandbox& sandbox() {
  static const Sandbox none;
  const Sandbox* const set = current().load();
  return set ? *set : none;
}

// change: of a copy, which is then everybody's. What a reader may still look at is kept.
template <typename Change>
void change_sandbox(Change change) {
  static std::mutex mutex;
  static std::deque<Sandbox> all;
  const std::lock_guard<std::mutex> lock(mutex);
  Sandbox next = sandbox();
  change(next);
  all.push_back(std::move(next));
  current().store(&all.back());
}

// Of a file that need not exist. Links are resolved; a path that cannot be resolved is taken as it is written.
fs::path resolved(const std::string& path) {
  std::error_code failed;
  fs::path real = fs::weakly_canonical(fs::absolute(path, failed), failed);
  if (failed) real = fs::absolute(path, failed).lexically_normal();
  return real.has_filename() ? real : real.parent_path();  // "a/" is "a"
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto apart = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return apart.first == folder.end() || (folder == folder.root_path());
}

bool is_below_any(const fs::path& path, const std::vector<fs::path>& folders) {
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) { return is_below(path, folder); });
}

std::string in_quotes(const fs::path& path) { return "\"" + path.string() + "\""; }

// As it is named, and where that is if a link or ".." leads elsewhere.
std::string describe_path(const std::string& path, const fs::path& real) {
  return in_quotes(path) + (fs::path(path) == real ? "" : ", which is " + in_quotes(real));
}

Diagnostic with_place(Diagnostic d, const std::string& path, const Diagnostic& at) {
  const bool placed = !at.file.empty() || !at.key.empty();
  d.file = placed ? at.file : path;
  d.line = at.line;
  d.key = at.key;
  return d;
}

}  // namespace

void enter_sandbox(const std::string& folder, const std::vector<std::string>& own, const std::string& cache) {
  std::error_code failed;
  const fs::path real = fs::canonical(folder, failed);
  if (failed || !fs::is_directory(real, failed))
    throw InputError({folder, 0, "--sandbox", "no such folder", "the folder that a mission may read", "", ""});
  change_sandbox([&](Sandbox& box) {
    box = {real, {}, {}, {}, cache.empty() ? fs::path() : resolved(cache)};
    for (const std::string& name : own) box.own.push_back(resolved(name));
  });
}

void leave_sandbox() {
  change_sandbox([](Sandbox& box) { box = {}; });
}

std::string sandbox_folder() { return sandbox().folder.string(); }

void allow_results(const std::string& folder) {
  if (sandbox().folder.empty()) return;
  change_sandbox([&](Sandbox& box) { box.results.push_back(resolved(folder)); });
}

void allow_output(const std::string& folder) {
  if (sandbox().folder.empty()) return;
  allow_results(folder);
  change_sandbox([&](Sandbox& box) { box.outputs.push_back(resolved(folder)); });
}

std::optional<Diagnostic> find_refusal(const std::string& path, const Diagnostic& at) {
  const Sandbox& box = sandbox();
  if (box.folder.empty()) return std::nullopt;
  const fs::path real = resolved(path);
  if (is_below(real, box.folder) || is_below_any(real, box.own) || is_below_any(real, box.results)) return std::nullopt;
  if (!box.cache.empty() && is_below(real, box.cache)) return std::nullopt;
  return with_place({"", 0, "", "the file lies outside the sandbox", "a file below " + in_quotes(box.folder),
                     describe_path(path, real),
                     "copy it into this folder and name it there; or name a folder with all files of the mission by "
                     "--sandbox; or leave --sandbox out if you trust whoever made the mission"},
                    path, at);
}

void check_may_read(const std::string& path, const Diagnostic& at) {
  if (auto refused = find_refusal(path, at)) throw RefusedFile(std::move(*refused));
}

void check_may_write(const std::string& path) {
  const Sandbox& box = sandbox();
  if (box.folder.empty() || box.outputs.empty()) return;
  const fs::path real = resolved(path);
  if (is_below_any(real, box.outputs) || (!box.cache.empty() && is_below(real, box.cache))) return;
  throw RefusedFile({path, 0, "", "would be written outside the output folder", "a file below " + in_quotes(box.outputs.back()),
                     describe_path(path, real), "choose another output folder by --out, without links in it"});
}

}  // namespace rubble
