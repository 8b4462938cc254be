// Prints the state hash of each standard scene; traces runs and names where two of them part.
//
//   hash_probe [--threads N] [--push METRES] [--scene NAME] [--trace FILE]
//   hash_probe --compare A B    exit status 1 and the first difference when the traces differ
//   hash_probe --libm           a hash of what this machine's sin, cos, exp and pow return
#if defined(__linux__)
#include <dlfcn.h>
#endif

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "tests/determinism/standard_scenes.h"
#include "tests/determinism/trace.h"

namespace rubble::determinism {
namespace {

// Of libm_tripwire, where that is preloaded. Not by a weak symbol: linkers differ in what they make of it.
void arm_tripwire() {
#if defined(__linux__)
  if (void* const arm = dlsym(RTLD_DEFAULT, "rubble_arm_tripwire")) reinterpret_cast<void (*)()>(arm)();
#endif
}

struct Arguments {
  SceneOptions scene;
  std::string only, trace, compare_a, compare_b;
  bool libm = false;
};

[[noreturn]] void refuse(const std::string& message) {
  Diagnostic d;
  d.message = message;
  d.hint =
      "hash_probe [--threads N] [--push METRES] [--scene NAME] [--trace FILE] | "
      "--compare A B | --libm";
  throw InputError(d);
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if (++i >= argc) refuse(option + " wants a value");
      return argv[i];
    };
    if (option == "--threads") {
      arguments.scene.threads = std::stoi(value());
    } else if (option == "--push") {
      arguments.scene.push = std::stod(value());
    } else if (option == "--scene") {
      arguments.only = find_scene(value()).name;
    } else if (option == "--trace") {
      arguments.trace = value();
    } else if (option == "--compare") {
      arguments.compare_a = value();
      arguments.compare_b = value();
    } else if (option == "--libm") {
      arguments.libm = true;
    } else {
      refuse("unknown option " + option);
    }
  }
  return arguments;
}

int compare(const Arguments& arguments) {
  const std::string difference = compare_traces(arguments.compare_a, arguments.compare_b);
  std::printf("%s\n", difference.empty() ? "the traces are the same" : difference.c_str());
  return difference.empty() ? 0 : 1;
}

// Not a result of ours: it shows that two runs really had two different libms.
int print_libm() {
  StateHash hash;
  for (int i = 1; i <= 20000; ++i) {
    const double x = 1e-3 * i;
    hash.add(std::sin(x)), hash.add(std::cos(x)), hash.add(std::exp(x)), hash.add(std::pow(x, 1.7));
  }
  std::printf("libm %s\n", hex64(hash.digest()).c_str());
  return 0;
}

int run(const Arguments& arguments) {
  std::optional<TraceWriter> trace;
  if (!arguments.trace.empty()) trace.emplace(arguments.trace);
  SceneOptions options = arguments.scene;
  if (trace) options.after_step = [&trace](const World& world) { trace->add(world); };
  std::printf("# scene step state_hash\n");
  for (const Scene& scene : standard_scenes()) {
    if (!arguments.only.empty() && scene.name != arguments.only) continue;
    if (trace) trace->begin_scene(scene.name);
    std::printf("%s\n", format_result(scene.name, scene.run(options)).c_str());
    std::fflush(stdout);
  }
  if (trace) trace->finish();
  return 0;
}

}  // namespace
}  // namespace rubble::determinism

int main(int argc, char** argv) {
  using namespace rubble::determinism;
  try {
    const Arguments arguments = parse(argc, argv);
    arm_tripwire();
    if (arguments.libm) return print_libm();
    return arguments.compare_a.empty() ? run(arguments) : compare(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hash_probe: %s\n", e.what());
    return 2;
  }
}
