#include "app/batch/sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/random.h"
#include "scripting/scenario/mission_form.h"

namespace rubble {
namespace {

constexpr std::size_t kMostVariants = 100'000;

struct Varied {
  std::string key;
  std::vector<std::string> values;  // of a list; of a range: its samples
  bool is_range = false;
  double low = 0, high = 0;  // of a range
};

[[noreturn]] void fail(const std::string& text, const std::string& what) {
  throw InputError({"", 0, "--vary", what, "KEY=1,2,3 or KEY=0.1..0.5 with --samples",
                    "\"" + text + "\"", "numbers of a vector are varied one at a time: "
                                        "lamp.position.x=0,1"});
}

bool parse_number(const std::string& text, double& number) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc() && read.ptr == end && std::isfinite(number);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

Varied parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) fail(text, "not a key with its values");
  Varied varied;
  varied.key = text.substr(0, equals);
  if (varied.key == "seed")
    throw InputError({"", 0, "--vary", "the seed is varied by an option of its own", "a key besides the seed", "\"" + text + "\"",
                      "--seeds gives the seeds, as in --seeds 1..1000 or --seeds 3,5,9"});
  const std::string rest = text.substr(equals + 1);
  const std::size_t dots = rest.find("..");
  varied.is_range = dots != std::string::npos && parse_number(rest.substr(0, dots), varied.low) &&
                    parse_number(rest.substr(dots + 2), varied.high);
  if (varied.is_range && varied.low >= varied.high) fail(text, "the range is empty");
  if (varied.is_range) return varied;
  varied.values = split(rest);
  for (const std::string& value : varied.values)
    if (value.empty()) fail(text, "a value is empty");
  std::vector<std::string> sorted = varied.values;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    fail(text, "a value occurs twice");
  return varied;
}

bool is_integer_key(const std::string& name) {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::string path = name;
  for (const Alias& alias : schema.aliases())
    if (alias.name == name) path = alias.path;
  const Key* const key = schema.find(path);
  if (!key || key->kind != KeyKind::value || path.find("[]") != std::string::npos) return false;
  const Slot slot = key->bind(0);
  return std::holds_alternative<int*>(slot) || std::holds_alternative<std::int64_t*>(slot) ||
         std::holds_alternative<std::uint64_t*>(slot);
}

// With six digits, or with as many more as keep the value within its part of the range.
std::string to_text(double value, const Varied& range, int part, int samples) {
  const auto part_of = [&](double x) { return std::floor((x - range.low) / (range.high - range.low) * samples); };
  for (int digits = 6; digits < 17; ++digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    double rounded = 0;
    if (parse_number(text, rounded) && part_of(rounded) == part) return text;
  }
  return exact_text(value);
}

// One value out of each of `samples` equal parts of the range, in random order.
void sample_range(Varied& varied, int samples) {
  RandomStream random(std::uint64_t(samples), "sweep/" + varied.key);
  const bool integers = is_integer_key(varied.key);
  std::vector<int> parts(std::size_t(samples), 0);
  std::iota(parts.begin(), parts.end(), 0);
  for (std::size_t i = parts.size(); i > 1; --i) std::swap(parts[i - 1], parts[random.below(i)]);
  const double width = varied.high - varied.low;
  for (const int part : parts) {
    const double at = (part + random.uniform(0, 1)) / samples;
    if (integers) {
      const double least = std::ceil(varied.low), count = std::floor(varied.high) - least + 1;
      varied.values.push_back(fixed_text(std::clamp(std::floor(least + at * count), varied.low, varied.high), 0));
      continue;
    }
    varied.values.push_back(to_text(std::clamp(varied.low + at * width, varied.low, varied.high), varied, part, samples));
  }
}

}  // namespace

std::vector<std::string> Sweep::overrides(std::size_t variant) const {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < keys.size(); ++i) texts.push_back(keys[i] + "=" + variants[variant][i]);
  return texts;
}

std::string Sweep::run_name(std::size_t variant, const std::string& seed) const {
  return (varies() ? "v" + std::to_string(variant + 1) + "_" : "") + "seed_" + seed;
}

Sweep make_sweep(const std::vector<std::string>& texts, int samples) {
  std::vector<Varied> all;
  bool ranges = false;
  for (const std::string& text : texts) {
    all.push_back(parse(text));
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (all[i].key == all.back().key) fail(text, "the key is varied twice");
    ranges = ranges || all.back().is_range;
  }
  if (ranges != (samples > 0))
    throw InputError({"", 0, "--samples",
                      ranges ? "how many points of the ranges of --vary" : "there is no range to sample",
                      ranges ? "a number" : "--vary KEY=LOW..HIGH", ranges ? "nothing" : "", ""});
  Sweep sweep;
  sweep.variants.emplace_back();
  for (Varied& varied : all) {
    if (varied.is_range) sample_range(varied, samples);
    sweep.keys.push_back(varied.key);
  }
  // Lists multiply; all ranges together are one further factor, whose index is the sample.
  std::vector<std::vector<std::size_t>> chosen{{}};  // an index of a value for each key
  const auto multiply = [&](std::size_t count, const std::vector<std::size_t>& keys) {
    std::vector<std::vector<std::size_t>> next;
    if (chosen.size() * count > kMostVariants)
      throw InputError({"", 0, "--vary", "too many combinations",
                        "at most " + std::to_string(kMostVariants), "", "draw --samples of ranges"});
    for (const auto& one : chosen)
      for (std::size_t i = 0; i < count; ++i) {
        next.push_back(one);
        next.back().resize(all.size());
        for (const std::size_t key : keys) next.back()[key] = i;
      }
    chosen = std::move(next);
  };
  std::vector<std::size_t> sampled;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].is_range)
      sampled.push_back(k);
    else
      multiply(all[k].values.size(), {k});
  }
  if (!sampled.empty()) multiply(std::size_t(samples), sampled);
  sweep.variants.clear();
  for (const auto& one : chosen) {
    sweep.variants.emplace_back();
    for (std::size_t k = 0; k < all.size(); ++k) sweep.variants.back().push_back(all[k].values[one[k]]);
  }
  return sweep;
}

}  // namespace rubble
