// What can differ between two processes: the layout of memory, the variant of libm, the linker.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace rubble::determinism {
namespace process_test {

struct Outcome {
  int status = -1;
  std::string text;  // stdout and stderr
};

Outcome run(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.text.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::string golden_table() {
  std::ifstream file(RUBBLE_SOURCE_DIR "/tests/golden/kernel.txt");
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::string kProbe = RUBBLE_HASH_PROBE;
// glibc 2.33 and later; before, the names were AVX2_Usable and FMA_Usable.
const std::string kPlainLibm = "env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA ";

TEST(Processes, PrintTheGoldenTable) {
  const Outcome outcome = run(kProbe);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, golden_table());
}

TEST(Processes, AgreeWithoutAddressRandomisation) {
  const Outcome outcome = run("setarch -R " + kProbe);
  if (outcome.text.find("failed to set personality") != std::string::npos) {
    GTEST_SKIP() << "this machine does not let a process turn address randomisation off";
  }
  EXPECT_EQ(outcome.text, golden_table());
}

TEST(Processes, AgreeWithLibmsPlainVariants) {
  EXPECT_EQ(run(kPlainLibm + kProbe).text, golden_table());
}

// The control of the test above: the two libms really differ.
TEST(Processes, LibmHasVariantsThatDiffer) {
  const Outcome usual = run(kProbe + " --libm"), plain = run(kPlainLibm + kProbe + " --libm");
  ASSERT_EQ(usual.status, 0) << usual.text;
  ASSERT_EQ(plain.status, 0) << plain.text;
  if (usual.text == plain.text) GTEST_SKIP() << "this processor has no FMA: one variant only";
}

TEST(Processes, ProbeRefusesWhatItDoesNotKnow) {
  const Outcome outcome = run(kProbe + " --scene no_such_scene");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.text.find("expected pile_layers"), std::string::npos) << outcome.text;
}

#ifdef RUBBLE_LIBM_TRIPWIRE
// A sanitizer has to be preloaded first, so these two run in ordinary builds only.
const std::string kTripwire = "env LD_PRELOAD=" RUBBLE_LIBM_TRIPWIRE " ";

TEST(Tripwire, NothingCallsLibmsTranscendentalsOrBlas) {
  const Outcome outcome = run(kTripwire + kProbe);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, golden_table());
}

TEST(Tripwire, EndsAProcessThatCallsLibm) {
  const Outcome outcome = run(kTripwire + kProbe + " --libm");
  EXPECT_EQ(outcome.status, 86) << outcome.text;
  EXPECT_NE(outcome.text.find("somebody calls"), std::string::npos) << outcome.text;
}
#endif

// Names that an archive of ours takes from elsewhere and that have no place on a result's path.
std::set<std::string> banned_symbols(const std::string& archive) {
  const std::regex banned(
      "(sin|cos|sincos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|exp10|"
      "expm1|log|log2|log10|log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma)[fl]?"
      "|[sdcz][a-z0-9]+_"  // BLAS and LAPACK
      "|s?rand|rand_r|drand48|random|getenv|secure_getenv|time|clock|gettimeofday"
      "|_ZNSt13random_device.*");
  const Outcome outcome = run("nm -u " + archive);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find(" U "), std::string::npos) << "nm lists nothing";
  std::set<std::string> found;
  const std::regex line(" U ([A-Za-z0-9_]+)");
  for (std::sregex_iterator i(outcome.text.begin(), outcome.text.end(), line), end; i != end; ++i) {
    const std::string name = (*i)[1];
    if (std::regex_match(name, banned)) found.insert(name);
  }
  return found;
}

TEST(Symbols, TheKernelTakesNoneThatDiffersBetweenMachines) {
  EXPECT_EQ(banned_symbols(RUBBLE_KERNEL_ARCHIVE), std::set<std::string>());
  EXPECT_EQ(banned_symbols(RUBBLE_BASE_ARCHIVE), std::set<std::string>());
}

// The control: hash_probe itself takes four for its option --libm.
TEST(Symbols, TheCheckSeesThem) {
  const std::set<std::string> found = banned_symbols(kProbe + " -D | sed s/@.*//");
  EXPECT_EQ(found.count("exp") + found.count("pow"), 2u);
}

}  // namespace process_test
}  // namespace rubble::determinism
