#include "scripting/schema/schema.h"

#include <algorithm>

namespace rubble {

std::string Key::name() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

std::string Key::parent() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

Key& Schema::group(std::string path, std::string doc) {
  Key& key = add(std::move(path), std::move(doc), {});
  key.kind = KeyKind::group;
  return key;
}

Key& Schema::add(std::string path, std::string doc, std::function<Slot(std::size_t)> bind) {
  Key key;
  key.path = std::move(path);
  key.doc_text = std::move(doc);
  key.bind = std::move(bind);
  keys_.push_back(std::move(key));
  return keys_.back();
}

void Schema::alias(std::string name, std::string path, bool negated) {
  aliases_.push_back({std::move(name), std::move(path), negated});
}

const Key* Schema::find(const std::string& path) const {
  for (const Key& key : keys_)
    if (key.path == path) return &key;
  return nullptr;
}

std::vector<const Key*> Schema::children(const std::string& parent) const {
  std::vector<const Key*> found;
  for (const Key& key : keys_)
    if (key.parent() == parent) found.push_back(&key);
  return found;
}

// Optimal string alignment distance: insertions, deletions, substitutions, swaps of neighbours.
static int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (std::size_t i = 0; i <= n; ++i) d[i][0] = int(i);
  for (std::size_t j = 0; j <= m; ++j) d[0][j] = int(j);
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j) {
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

std::string nearest_name(const std::string& written, const std::vector<std::string>& names) {
  constexpr std::size_t kLongestName = 64;
  if (written.size() > kLongestName) return {};
  std::string best;
  int best_distance = 1 + std::max(1, int(written.size()) / 3);
  for (const std::string& name : names) {
    if (std::abs(int(name.size()) - int(written.size())) >= best_distance) continue;
    const int distance = edit_distance(written, name);
    if (distance < best_distance) best = name, best_distance = distance;
  }
  if (best.empty())  // a unit left out: "yaw" for "yaw_deg"
    for (const std::string& name : names)
      if (best.empty() && written.size() > 2 && name.rfind(written + "_", 0) == 0) best = name;
  return best;
}

}  // namespace rubble
