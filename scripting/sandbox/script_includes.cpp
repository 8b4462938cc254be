#include "scripting/sandbox/script_includes.h"

#include <algorithm>
#include <stdexcept>

#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/tables/text_table.h"
#include "kernel/base/text.h"
#include "scripting/files/data_grid.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostIncludes = 64;
constexpr std::uintmax_t kLargestInclude = 4 << 20;  // unit: byte
constexpr std::uintmax_t kLargestGrid = 512 << 20;   // of a picture or an elevation model; unit: byte

}  // namespace

// The file's text; otherwise the reason goes into `error`.
std::optional<std::string> ScriptIncludes::read(const fs::path& relative, std::uintmax_t largest,
                                                std::string& error) const {
  const std::string name = "\"" + relative.string() + "\"";
  if (served_) {
    const auto found = served_->find(relative.lexically_normal().string());
    if (found != served_->end()) return found->second;
    return error = name + " is not among the files that were kept with the script", std::nullopt;
  }
  std::error_code failed;
  const fs::path folder = fs::weakly_canonical(fs::path(chunks_[0].path).parent_path() / ".", failed);
  const fs::path path = fs::weakly_canonical(folder / relative, failed);
  if (const auto refused = find_refusal(path.string()))
    return error = name + ": " + refused->message + ": expected " + refused->expected + ", found " + refused->found + " (" +
                   refused->hint + ")",
           std::nullopt;
  const auto apart = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  if (failed || (apart.first != folder.end() && !apart.first->empty()))
    return error = name + " leads out of the script's folder", std::nullopt;
  error = "no readable file " + name + " beside the script";
  if (!fs::is_regular_file(path, failed)) return std::nullopt;
  if (fs::file_size(path, failed) > largest)
    return error = name + " is larger than " + std::to_string(largest >> 20) + " MiB", std::nullopt;
  try {
    return read_file(path.string(), largest);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

int ScriptIncludes::keep(const fs::path& relative, std::string text) {
  const std::string shown = (fs::path(chunks_[0].path).parent_path() / relative).string();
  const std::string hash = sha256(text);
  chunks_.push_back({shown, std::move(text), hash});
  const bool known = std::any_of(included_.begin(), included_.end(),
                                 [&](const SourceFile& file) { return file.path == shown; });
  if (!known) included_.push_back(chunks_.back());
  return int(chunks_.size()) - 1;
}

std::optional<fs::path> ScriptIncludes::path_inside(const std::string& name, std::string& error) const {
  const fs::path relative(name);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (!name.empty() && !relative.is_absolute() && !climbs) return relative;
  error = "\"" + name + "\" is not a path inside the script's folder";
  return std::nullopt;
}

int ScriptIncludes::open_text(const std::string& name, std::string& error) {
  const auto relative = path_inside(name, error);
  if (!relative) return -1;
  std::optional<std::string> text = read(*relative, kLargestInclude, error);
  if (!text) return -1;
  if (chunks_.size() > kMostIncludes) return error = "more than 64 files", -1;
  if (find_invalid_utf8(*text) != std::string_view::npos) {
    error = "\"" + name + "\" is not UTF-8 text";
    if (is_utf16(*text)) error += " but UTF-16: save it as UTF-8";
    if (is_data_grid(*text)) error += " but a picture: rubble.read_image reads it";
    return -1;
  }
  return keep(*relative, std::move(*text));
}

// Manifests keep text. One that was made for another side than usual has it in its name.
int ScriptIncludes::open_grid(const std::string& name, int side, std::string& error) {
  auto relative = path_inside(name, error);
  if (!relative) return -1;
  fs::path kept = *relative;
  if (side != kUsualSide) kept += "#" + std::to_string(side);
  std::optional<std::string> bytes = read(served_ ? kept : *relative, kLargestGrid, error);
  if (!bytes) return -1;
  if (chunks_.size() > kMostIncludes) return error = "more than 64 files", -1;
  try {
    const bool small_text = bytes->size() <= kLargestInclude && find_invalid_utf8(*bytes) == std::string_view::npos;
    const DataGrid whole = read_data_grid(*bytes, served_.has_value());
    DataGrid grid = thinned(whole, side);
    if (!small_text || grid.block != whole.block) *bytes = data_grid_text(grid);
  } catch (const std::runtime_error& failure) {
    return error = "\"" + name + "\" " + failure.what(), -1;
  }
  return keep(kept, std::move(*bytes));
}

}  // namespace rubble
