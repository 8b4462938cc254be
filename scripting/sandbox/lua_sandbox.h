// Runs a stranger's Lua script and hands back the table that it returns, as plain data.
//
// A script computes, and nothing else: no files, processes, clock, bytecode, coroutines or
// metatables, bounded memory, instructions and time, and the same result on every machine: random
// numbers come from the seed, `pairs` goes in the order of the keys, `table.sort` is stable, and
// sin, cos and the like have portable bits. (`x ^ y` is the C library's pow, the one exception.)
// What scripts have instead is listed in docs/reference/missions.md and made in lua_prelude.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/values/value.h"

namespace rubble {

struct SandboxLimits {
  std::size_t memory = std::size_t(128) << 20;  // of the script at any time; unit: byte
  std::uint64_t instructions = 200'000'000;     // of Lua's virtual machine
  // CPU time, for what instructions do not count (work on huge strings). Only a script that fails
  // can notice it. unit: s
  double seconds = 20;
};

struct SourceFile {
  std::string path;    // as errors name it
  std::string text;    // the whole file
  std::string sha256;  // of the text; 64 hexadecimal digits
};

// A function of the library and the parameters that it asked rubble.options for.
struct DescribedFunction {
  std::string name;   // "rubble.wall"
  Value description;  // the table that it gave to rubble.options
};

class LuaSandbox {
 public:
  // seed: of rubble.random and math.random. entry: the function that a script passes its table to,
  // "rubble.mission" or "pack".
  LuaSandbox(std::uint64_t seed, const std::string& entry, const SandboxLimits& limits = {});
  ~LuaSandbox();
  LuaSandbox(const LuaSandbox&) = delete;
  LuaSandbox& operator=(const LuaSandbox&) = delete;

  // From now on rubble.include reads these texts, by their path relative to the script's folder, and
  // no file: a script that is kept in a manifest runs without its folder.
  void serve_includes(std::map<std::string, std::string> texts);

  // Values of parameters that the script declares by rubble.parameter, "NAME=VALUE", and of options of functions,
  // "rubble.collapse.lean_to.height=2", instead of the script's. Before run(). taken_names: no parameter's.
  void set_overrides(const std::vector<std::string>& overrides, std::vector<std::string> taken_names);
  // Those that nothing in the script took, each with a hint at what there is; empty: no idea.
  std::vector<std::pair<std::string, std::string>> unused_overrides() const;
  const std::map<std::string, std::string>& parameters() const;  // that the script declared, with their values

  // Runs the script once and returns its value. `path` names it in errors, and files that it
  // includes are looked for beside it. Throws InputError with file and line.
  Value run(const std::string& text, const std::string& path);

  // How many functions the script gave to rubble.controller. They have the numbers from 1 on.
  int controllers() const;
  // Calls one of them, by its number, once the script has run.
  // Limits hold for each call by itself: 2 million instructions. Throws InputError with file and line.
  Value call_controller(int number, const Value& argument);

  // What rubble.options found wrong in that run, with file and line.
  const std::vector<Diagnostic>& mistakes() const;

  bool used_random() const;                         // whether the seed mattered to the script
  // The first values that it drew, as text, at most eight of each of its streams and 64 in all. Names:
  // that of the stream, and for its second value on NAME.2, ...; of a direction NAME.x, .y, .z. Of a
  // choice among tables, the number of the one.
  const std::vector<std::pair<std::string, std::string>>& drawn() const;
  const std::vector<SourceFile>& included() const;  // by rubble.include, in order of first use
  std::vector<std::string> take_printed();  // lines given to print since the last call, made printable

  // The functions of the library with their parameters, in order, for the reference.
  static std::vector<DescribedFunction> describe_library();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
